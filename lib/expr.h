/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Expressions of the fields of a snapshot, one number a particle, with units:
 *
 *   sqrt(Velocities.x^2 + Velocities.y^2)/SoundSpeed
 *   Density > 2.7g/cc && MaterialID == 'ice'
 *
 * Names are those of datasets; .x .y .z and .xx .xy ... are components, a vector or tensor without
 * is its length. Operators, loosest first: || && == != < <= > >= + - * / unary - and !, ^ (from the
 * right); |a| is the magnitude. A number may carry a unit (3km, 2.7g/cc), a bare one takes that of
 * what it is added to or compared with. Comparisons are 1 or 0. 'ice' (or "ice") is the index of a
 * material of the file; `odd name` a dataset whose name is no word. Functions: EXPR_FUNCTIONS. */
#ifndef EXPR_H
#define EXPR_H

#include "part.h"

/* X(name, arguments, rule for units, value in terms of a, b, c). PLAIN: of a number without unit;
 * LOG: of the number in SI. */
/* clang-format off */
#define EXPR_FUNCTIONS(X) \
  X(abs,   1, SAME,  fabs(a))       X(sqrt,  1, ROOT2, sqrt(a))       X(cbrt,  1, ROOT3, cbrt(a)) \
  X(exp,   1, PLAIN, exp(a))        X(log,   1, LOG,   log(a))        X(log10, 1, LOG,   log10(a)) \
  X(sin,   1, ANGLE, sin(a))        X(cos,   1, ANGLE, cos(a))        X(tan,   1, ANGLE, tan(a)) \
  X(asin,  1, PLAIN, asin(a))       X(acos,  1, PLAIN, acos(a))       X(atan,  1, PLAIN, atan(a)) \
  X(floor, 1, PLAIN, floor(a))      X(sign,  1, LOG,   (a > 0) - (a < 0)) \
  X(min,   2, SAME,  a < b ? a : b) X(max,   2, SAME,  a > b ? a : b) X(hypot, 2, SAME,  hypot(a, b)) \
  X(atan2, 2, RATIO, atan2(a, b))   X(mod,   2, SAME,  fmod(a, b)) \
  X(if,    3, IF,    a != 0 ? b : c)
/* clang-format on */

typedef struct Expr Expr;

/* expr_parse: NULL when it is no expression; the message says where. */
Expr *expr_parse(const char *text, Err *err);
void expr_free(Expr *e);

/* expr_members: appends the members of the schema that it needs to `members` (separated by blanks,
 * as snap_read_some has them) where they are not in it yet. Returns 1 when it also needs fields
 * that the schema does not know, 0 when not, -1 when they do not fit. */
int expr_members(const Expr *e, char *members, int size);

/* expr_bind: looks its names up in p, which must stay until it is bound to something else; file:
 * for messages. Errors: those of column_get, no such function or material, units that do not go
 * together. */
int expr_bind(Expr *e, const Parts *p, const char *file, Err *err);

/* expr_unit: of the bound expression, "1" for none. expr_kinds: whether it is the bare name of a
 * field whose numbers name kinds. */
const char *expr_unit(const Expr *e);
int expr_kinds(const Expr *e);

/* expr_eval: all particles, out [p->n]; parallel. expr_eval_float: the same, rounded. */
void expr_eval(const Expr *e, double *out);
void expr_eval_float(const Expr *e, float *out);

/* expr_select: parses, binds and evaluates a condition: keep [p->n] 1 where it is not 0 nor NaN,
 * malloc'ed; NULL on error, and when it holds nowhere. */
unsigned char *expr_select(const char *text, const Parts *p, const char *file, Err *err);

#endif
