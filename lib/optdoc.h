/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What an option table says to people: --help, the man page, a section of docs/options.md. Used by
 * opt.c. */
#ifndef OPTDOC_H
#define OPTDOC_H

#include "opt.h"

/* optdoc_standard: the options that every program has (--help ...); ends with a NULL name. */
extern const Opt optdoc_standard[];

/* optdoc_help, optdoc_man (troff), optdoc_markdown: to stdout. */
void optdoc_help(const OptProgram *p);
void optdoc_man(const OptProgram *p);
void optdoc_markdown(const OptProgram *p);

/* optdoc_argument: how the option's argument is shown ("<kg>", "hcp|cubic"), "" for a flag; returns
 * buf. */
const char *optdoc_argument(const Opt *o, char *buf, int size);

#endif
