/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Errors. A library function fills an Err and returns -1 or NULL; only a program prints and exits.
 * Every message is one line, `program: what failed: reason`: lower case, no full stop, names
 * quoted. */
#ifndef ERR_H
#define ERR_H

enum { ERR_FAILED = 1, ERR_USAGE = 2, ERR_STOPPED = 3 }; /* exit codes; 3: stopped and resumable */

typedef struct {
  char text[1024];
} Err;

/* err_set: formats the message into e (e may be NULL); returns -1 so that callers can `return
 * err_set(...)`. */
int err_set(Err *e, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* err_null: the same, for functions that return a pointer. */
void *err_null(Err *e, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* err_program: names the program in all later messages (argv[0] or a name; the last path element is
 * kept). */
void err_program(const char *argv0);

/* err_name: the program's name. */
const char *err_name(void);

/* err_die: prints `program: message` on stderr after flushing stdout and exits with ERR_FAILED. */
void err_die(const char *format, ...) __attribute__((format(printf, 1, 2), noreturn));

/* err_usage: the same with ERR_USAGE and a hint to --help. */
void err_usage(const char *format, ...) __attribute__((format(printf, 1, 2), noreturn));

/* err_warn: prints `program: warning: message` on stderr and goes on. */
void err_warn(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* err_close_stdout: flushes and closes stdout; dies if anything written to it was lost (full disk,
 * closed pipe). */
void err_close_stdout(void);

#endif
