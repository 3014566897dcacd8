/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `eos fill`: temperature, entropy and phase of the particles of a snapshot. */
#ifndef FILL_H
#define FILL_H

/* fill_main: what main is to a program; argv is the whole command line, argv[1] is "fill". */
int fill_main(int argc, char **argv);

#endif
