/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Quantities with unit suffixes, as users type them in options and configs: 437km, 2000min, 48deg,
 * 0.9Mearth, 2.7g/cc. Everything inside the programs is SI; a bare number is SI. The units of one
 * kind are named by the SI unit of that kind: "m", "s", "kg", "m/s", "rad", "kg/m^3", "J/kg", "Pa",
 * "K", "J/K/kg", "1/m^3", "1" (no unit) ... */
#ifndef UNIT_H
#define UNIT_H

#include "err.h"

#define UNIT_G 6.67430e-11 /* m^3/kg/s^2, CODATA 2018 */

/* unit_parse: reads a number with an optional suffix into SI.
 * kind: the SI unit wanted; a suffix of another kind, an unknown one (with the nearest known one),
 * text behind it, an empty string, inf and nan are errors. Powers (g/cm^3, g/cc, 1/m^3) and
 * products are understood. Returns 0 or -1. */
int unit_parse(const char *text, const char *kind, double *si, Err *err);

/* unit_powers: factor to SI and the powers of m, kg, s, K, rad of a unit; "1" and "" have none.
 * Returns 0, or -1 when it is none. */
enum { UNIT_BASES = 5 };
int unit_powers(const char *unit, double *factor, int power[UNIT_BASES], Err *err);

/* unit_list: "X,Y,Z": n quantities of one kind, separated by commas. Returns 0 or -1. */
int unit_list(const char *text, const char *kind, int n, double *si, Err *err);

/* unit_count: a whole number: 20000, 2e4, 20k, 1M. Exact up to 2^53. Returns 0 or -1. */
int unit_count(const char *text, long *count, Err *err);

/* unit_suffix: splits "1.7vesc" into 1.7 and "vesc" for callers with units of their own (escape
 * speeds, r1+r2). *suffix points into text. Returns 0, or -1 when text does not begin with a finite
 * number. */
int unit_suffix(const char *text, double *number, const char **suffix, Err *err);

/* unit_nearest: the candidate closest to word by edit distance, or NULL when none is near
 * (regardless of case; more than a third of the word would have to change). */
const char *unit_nearest(const char *word, const char *const *candidates, int n);

/* unit_choice: the position of word in choices "a|b|c", or -1 (the message names the nearest, or
 * all of them). */
int unit_choice(const char *word, const char *choices, Err *err);

/* unit_time_text, unit_length_text: a value in the unit a person would choose ("93.3 min", "437
 * km"); returns buf. */
const char *unit_time_text(double seconds, char *buf, int size);
const char *unit_length_text(double metres, char *buf, int size);

#endif
