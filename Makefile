# SPDX-License-Identifier: GPL-3.0-or-later
# breccia: `make` builds everything into bin/, `make help` says what else there is.
# Tools, tests and benches are found by themselves: tools/NAME/*.c makes bin/NAME, tests/test_NAME.c a test, bench/NAME.c a bench.

VERSION = 0.1.0
PREFIX = /usr/local
CC = gcc
CXX = g++
OPT = -O3 -march=native
WARN = -Wall -Wextra -Wpedantic -Wshadow
CPPFLAGS =
LDFLAGS =
T = *

# sqrt need not set errno and nothing traps; NaN and infinity keep their meaning. LOOPS, for the pair loops only: sums may be
# reordered, so that they can be vectorised.
MATH = -fno-math-errno -fno-trapping-math
LOOPS = -fassociative-math -fno-signed-zeros -freciprocal-math
ifdef asan
OPT = -O1 -g -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
B = build/asan
BIN = build/asan/bin
else
B = build
BIN = bin
endif

hdf5 := $(firstword $(wildcard /usr/include/hdf5/serial))
hdf5lib := $(firstword $(wildcard /usr/lib/*/hdf5/serial))
cpp = -D_POSIX_C_SOURCE=200809L -DBRECCIA_VERSION='"$(VERSION)"' -I. $(hdf5:%=-isystem %) $(CPPFLAGS)
cflags = -std=c11 $(OPT) $(WARN) $(MATH) -fopenmp $(CFLAGS)
cxxflags = -std=c++17 $(filter-out -std=c11 -Wpedantic,$(cflags)) -Wno-unknown-pragmas -Itests/host
libs = $(LDFLAGS) $(hdf5lib:%=-L%) -lhdf5 -lconfig -lgsl -lgslcblas -lpng -lz -lm

tools := $(notdir $(patsubst %/,%,$(wildcard tools/*/)))
programs := $(tools) $(if $(wildcard solver/main.c),solver)
cu_tests := $(patsubst tests/%.cu,%,$(wildcard tests/test_*.cu))
tests := $(patsubst tests/%.c,%,$(wildcard tests/test_*.c)) $(cu_tests)
benches := $(patsubst bench/%.c,%,$(wildcard bench/*.c))
lib_o := $(patsubst %.c,$B/%.o,$(wildcard lib/*.c))
solver_o := $(patsubst %.c,$B/%.o,$(filter-out solver/main.c,$(wildcard solver/*.c solver/*/*.c)))
host_o := $(patsubst %.cpp,$B/%.o,$(wildcard tests/host/*.cpp))
objs = $(patsubst %.c,$B/%.o,$(wildcard $(1)/*.c))

all: $(programs:%=$(BIN)/%) $(if $(asan),,$(benches:%=$B/bench/%))

.SECONDEXPANSION:
$(BIN)/solver: $B/solver/main.o
$(tools:%=$(BIN)/%): $$(call objs,tools/$$(@F))
$(programs:%=$(BIN)/%): $B/libsolver.a $B/libbreccia.a
	@mkdir -p $(@D)
	$(CC) $(cflags) -o $@ $(filter %.o,$^) $(filter %.a,$^) $(libs)
$B/tests/test_%: $B/tests/test_%.o $B/libsolver.a $B/libbreccia.a
	$(CC) $(cflags) -o $@ $^ -lcmocka $(libs)
# Tests of CUDA code run without a GPU: tests/host/ stands in for the toolkit.
$(cu_tests:%=$B/tests/%): %: %.o $B/libhost.a $B/libsolver.a $B/libbreccia.a
	$(CXX) $(cxxflags) -o $@ $^ -lcmocka $(libs)
$B/bench/%: $B/bench/%.o $B/libsolver.a $B/libbreccia.a
	$(CC) $(cflags) -o $@ $^ $(libs)
$B/libbreccia.a: $(lib_o)
$B/libsolver.a: $(solver_o)
$B/libhost.a: $(host_o)
$B/libbreccia.a $B/libsolver.a $B/libhost.a:
	@mkdir -p $(@D)
	@rm -f $@
	ar rc $@ $^

$B/solver/cpu/%.o $B/lib/gravity.o $B/lib/ngb.o: MATH += $(LOOPS)
$B/lib/gravity.o $B/lib/ngb.o: MATH += -ffp-contract=fast
$B/%.o: %.c $B/flags
	@mkdir -p $(@D)
	$(CC) $(cpp) $(cflags) -MMD -MP -c -o $@ $<
$B/tests/%.o: tests/%.cu $B/flags
	@mkdir -p $(@D)
	$(CXX) $(cpp) $(cxxflags) -MMD -MP -x c++ -c -o $@ $<
$B/tests/%.o: tests/%.cpp $B/flags
	@mkdir -p $(@D)
	$(CXX) $(cpp) $(cxxflags) -MMD -MP -c -o $@ $<
# Changed flags rebuild everything.
$B/flags: FORCE
	@mkdir -p $(@D)
	@echo '$(CC) $(cpp) $(cflags)' | cmp -s - $@ || echo '$(CC) $(cpp) $(cflags)' > $@
-include $(shell find $B -name '*.d' 2>/dev/null)

# `make check` runs all tests, `make check T=eos` those whose name matches.
check: all $(tests:%=$B/tests/%)
	@BIN=$(abspath $(BIN)) B=$(abspath $B) tests/run '$(T)'

bench: all
	@for b in $(benches:%=$B/bench/%); do $$b || exit 1; done

lint: all
	@tests/lint $B

docs: all
	@BIN=$(abspath $(BIN)) docs/generate

deps:
	@./deps

install: all
	install -d $(DESTDIR)$(PREFIX)/bin $(DESTDIR)$(PREFIX)/share/breccia/materials $(DESTDIR)$(PREFIX)/share/breccia/pipelines
	install -m 755 $(programs:%=$(BIN)/%) $(DESTDIR)$(PREFIX)/bin
	install -m 644 materials/*.cfg $(DESTDIR)$(PREFIX)/share/breccia/materials
	install -m 644 pipelines/* $(DESTDIR)$(PREFIX)/share/breccia/pipelines
	install -d $(DESTDIR)$(PREFIX)/share/man/man1
	@for p in $(programs); do $(BIN)/$$p --man > $(DESTDIR)$(PREFIX)/share/man/man1/$$p.1 || exit 1; done

clean:
	rm -rf build bin

help:
	@echo 'make            build everything into bin/'
	@echo 'make deps       install what the build needs (apt-get)'
	@echo 'make check      run all tests; make check T=eos runs those that match'
	@echo 'make bench      check, then time, the hot passes'
	@echo 'make lint       format, lengths, exported names'
	@echo 'make docs       the generated tables of docs/'
	@echo 'make install PREFIX=/usr/local'
	@echo 'make asan=1 check     the same with address and undefined-behaviour sanitizers'

FORCE:
.PHONY: all check bench lint docs deps install clean help FORCE
.DELETE_ON_ERROR:
.SECONDARY:
