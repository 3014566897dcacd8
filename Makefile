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
# CUDA, where nvcc is: NVCC= builds without. ARCH=native or ARCH=sm_90: for one card only.
NVCC := $(firstword $(shell command -v nvcc) $(wildcard $(CUDA_HOME:%=%/bin/nvcc) /usr/local/cuda/bin/nvcc))
ARCH ?= all

# sqrt need not set errno and nothing traps; NaN and infinity keep their meaning. LOOPS, for the pair loops only: sums may be
# reordered, so that they can be vectorised.
MATH = -fno-math-errno -fno-trapping-math
LOOPS = -fassociative-math -fno-signed-zeros -freciprocal-math
ifdef asan
OPT = -O1 -g -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
B = build/asan
BIN = build/asan/bin
NVCC :=
else
B = build
BIN = bin
endif

hdf5 := $(firstword $(wildcard /usr/include/hdf5/serial))
hdf5lib := $(firstword $(wildcard /usr/lib/*/hdf5/serial))
cpp = -D_POSIX_C_SOURCE=200809L -DBRECCIA_VERSION='"$(VERSION)"' -I. $(hdf5:%=-isystem %) $(CPPFLAGS)
cflags = -std=c11 $(OPT) $(WARN) $(MATH) -fopenmp $(CFLAGS)
cxxflags = -std=c++17 $(filter-out -std=c11 -Wpedantic -Wshadow,$(cflags)) -Wno-unknown-pragmas -Itests/host
libs = $(LDFLAGS) $(hdf5lib:%=-L%) -lhdf5 -lconfig -lgsl -lgslcblas -lpng -lz -lm $(cudalibs) -lpthread

comma := ,
cuda := $(wildcard solver/cuda/*.cu)
# The runtime is linked statically: the same programs start where there is no GPU and no driver.
ifneq ($(NVCC),)
toolkit := $(patsubst %/bin/nvcc,%,$(realpath $(NVCC)))
cudart := $(firstword $(wildcard $(addsuffix /libcudart_static.a,$(toolkit)/lib64 $(toolkit)/lib /usr/lib/*-linux-gnu)))
cudalibs := $(cudart) -ldl -lrt -Wl,--as-needed -lstdc++
codes := $(if $(filter all,$(ARCH)),$(foreach a,75 80 86 89 90,-gencode arch=compute_$a$(comma)code=sm_$a) \
  -gencode arch=compute_90$(comma)code=compute_90,-arch=$(ARCH))
nvccflags = -std=c++17 -O3 $(codes) $(CUDAMATH) -Xcompiler -Wall,-Wextra,-fopenmp $(NVCCFLAGS)
endif

tools := $(notdir $(patsubst %/,%,$(wildcard tools/*/)))
programs := $(tools) $(if $(wildcard solver/main.c),solver)
cu_tests := $(patsubst tests/%.cu,%,$(wildcard tests/test_*.cu))
c_tests := $(patsubst tests/%.c,%,$(wildcard tests/test_*.c))
cuda_tests := $(filter test_cuda%,$(c_tests))
tests := $(c_tests) $(cu_tests)
benches := $(patsubst bench/%.c,%,$(wildcard bench/*.c))
gpu_benches := $(patsubst bench/%.cu,%,$(wildcard bench/*.cu))
lib_o := $(patsubst %.c,$B/%.o,$(wildcard lib/*.c))
solver_c := $(filter-out solver/main.c $(if $(NVCC),solver/nocuda/%),$(wildcard solver/*.c solver/*/*.c))
solver_o := $(solver_c:%.c=$B/%.o) $(if $(NVCC),$(cuda:%.cu=$B/%.o))
host_o := $(patsubst %.cpp,$B/%.o,$(wildcard tests/host/*.cpp)) $(cuda:%.cu=$B/host/%.o)
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
# Tests of CUDA code run without a GPU: tests/host/ stands in for the toolkit. All tests on the GPU, for check-gpu.
$(cuda_tests:%=$B/tests/%): whole = -Wl,-u,backend_cuda
$(cu_tests:%=$B/tests/%) $(cuda_tests:%=$B/tests/%): %: %.o $B/libhost.a $B/libsolver.a $B/libbreccia.a
	$(CXX) $(cxxflags) $(whole) -o $@ $^ -lcmocka $(libs)
$B/host/tests/test_%: $B/tests/test_%.o $B/libhost.a $B/libsolver.a $B/libbreccia.a
	@mkdir -p $(@D)
	$(CXX) $(cxxflags) -Wl,-u,backend_cuda -o $@ $^ -lcmocka $(libs)
$B/gpu/tests/test_%: $B/tests/test_%.o $B/libsolver.a $B/libbreccia.a
	@mkdir -p $(@D)
	$(CC) $(cflags) -o $@ $^ -lcmocka $(libs)
$(cu_tests:%=$B/gpu/tests/%): %: %.o $B/libsolver.a $B/libbreccia.a
	@mkdir -p $(@D)
	$(CC) $(cflags) -o $@ $^ -lcmocka $(libs)
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
$B/host/%.o: %.cu $B/flags
	@mkdir -p $(@D)
	$(CXX) $(cpp) $(cxxflags) -MMD -MP -x c++ -c -o $@ $<
# Where only single precision is at stake: approximate division and square root, no denormal numbers.
$B/solver/cuda/loops_mixed.o $B/solver/cuda/gravity.o: CUDAMATH = -use_fast_math
$B/gpu/%.o: %.cu $B/flags
	@mkdir -p $(@D)
	$(NVCC) $(cpp) $(nvccflags) -MMD -MP -c -o $@ $<
$B/%.o: %.cu $B/flags
	@mkdir -p $(@D)
	$(NVCC) $(cpp) $(nvccflags) -MMD -MP -c -o $@ $<
$B/tests/%.o: tests/%.cpp $B/flags
	@mkdir -p $(@D)
	$(CXX) $(cpp) $(cxxflags) -MMD -MP -c -o $@ $<
# Changed flags rebuild everything.
allflags = $(CC) $(cpp) $(cflags) $(CXX) $(NVCC) $(nvccflags)
$B/flags: FORCE
	@mkdir -p $(@D)
	@echo '$(allflags)' | cmp -s - $@ || echo '$(allflags)' > $@
-include $(shell find $B -name '*.d' 2>/dev/null)

# `make check` runs all tests, `make check T=eos` those whose name matches.
check: all $(tests:%=$B/tests/%)
	@BIN=$(abspath $(BIN)) B=$(abspath $B) tests/run '$(T)'

# The solver's tests on the CUDA backend as the host has it: slow.
check-host: $(c_tests:%=$B/host/tests/%)
	@BIN=$(abspath $(BIN)) B=$(abspath $B/host) BRECCIA_TEST_DEVICE=cuda tests/run 'test_$(T)'

# The same tests, and those of CUDA code, on a GPU.
check-gpu: all $(filter-out $B/gpu/tests/test_host_%,$(tests:%=$B/gpu/tests/%))
	@BIN=$(abspath $(BIN)) B=$(abspath $B/gpu) BRECCIA_TEST_DEVICE=cuda tests/run '$(T)'

# Those of CUDA code on a GPU under compute-sanitizer, small: TOOLS='memcheck racecheck', LIMIT=150 s each, JOBS at a time.
check-sanitizer: $(patsubst %,$B/gpu/tests/%,$(filter test_cuda%,$(tests)))
	@B=$(abspath $B/gpu) TOOLS='$(TOOLS)' LIMIT='$(LIMIT)' JOBS='$(JOBS)' tests/sanitize '$(T)'

bench: all
	@for b in $(benches:%=$B/bench/%); do PATH=$(abspath $(BIN)):$$PATH $$b || exit 1; done

# The same on a GPU: its passes, then whole steps.
bench-gpu: all $(gpu_benches:%=$B/bench/%)
	@for b in $(gpu_benches:%=$B/bench/%); do $$b || exit 1; done
	@for n in 200000 1000000; do for c in solid hydro; do $B/bench/step $$n $$c cuda || exit 1; done; done

# What each law and setting costs, as TSV: make bench-cost N=1000000 DEVICE=cuda >costs.tsv; bench/cost -p costs.tsv puts it into
# bench/compare.md. K: of the settings that match.
N =
DEVICE = cpu
K = *
bench-cost: all
	@PATH=$(abspath $(BIN)):$$PATH bench/cost $(N:%=-n %) -d $(DEVICE) -k '$(K)' $B/bench/step

# Every experiment that judges itself, at SIZE; check-physics: the small ones, as a test.
SIZE = small
validate: all
	@$(MAKE) --no-print-directory -f pipelines/validate.mk BIN=$(abspath $(BIN)) SIZE=$(SIZE)
check-physics: all
	@$(MAKE) --no-print-directory -f pipelines/validate.mk BIN=$(abspath $(BIN)) SIZE=small

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
	install -d $(DESTDIR)$(PREFIX)/share/breccia/python
	install -m 644 python/breccia.py $(DESTDIR)$(PREFIX)/share/breccia/python
	install -d $(DESTDIR)$(PREFIX)/share/man/man1
	@for p in $(programs); do $(BIN)/$$p --man > $(DESTDIR)$(PREFIX)/share/man/man1/$$p.1 || exit 1; done

clean:
	rm -rf build bin

help:
	@echo 'make            build everything into bin/'
	@echo 'make deps       install what the build needs (apt-get)'
	@echo 'make check      run all tests; make check T=eos runs those that match'
	@echo 'make check-gpu  the same on a GPU'
	@echo 'make check-sanitizer  the tests of CUDA code under compute-sanitizer, on a GPU'
	@echo 'make validate   run the experiments and write out/validate/SIZE/validation.html; SIZE=small|medium|large'
	@echo 'make bench      check, then time, the hot passes; make bench-gpu on a GPU'
	@echo 'make bench-cost what each law and setting costs; N=1000000 DEVICE=cuda K=strength*'
	@echo 'make lint       format, lengths, exported names'
	@echo 'make docs       the generated tables of docs/'
	@echo 'make install PREFIX=/usr/local'
	@echo 'make asan=1 check     the same with address and undefined-behaviour sanitizers'

FORCE:
.PHONY: all check validate check-physics check-gpu check-host check-sanitizer bench bench-gpu bench-cost lint docs deps install clean help FORCE
.DELETE_ON_ERROR:
.SECONDARY:
