/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `eos table`: tables made, looked at and converted. */
#ifndef MAKE_H
#define MAKE_H

/* make_main: what main is to a program; argv[0] is "table". */
int make_main(int argc, char **argv);

#endif
