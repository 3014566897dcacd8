/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files of tabulated equations of state, in three formats:
 *
 * hdf5    ours, of either kind: datasets Density [nrho], InternalEnergy or Temperature [ny] (the
 *         axes) and Pressure, SoundSpeed, Entropy, Phase and the other of the two [nrho][ny], each
 *         with unit and meaning; attribute Source
 * sesame  text of WoMa and SWIFT: 12 header lines with #, a date YYYYMMDD, the numbers of densities
 *         and temperatures, both axes, then rows of u, p, c, s; T outer
 * miluph  text of miluphANEOS: three header lines, then rows of rho, u, p, T, c, s, phase; rho
 *         outer, the same energies for every density */
#ifndef TABFILE_H
#define TABFILE_H

#include "table.h"

#define TABFILE_FORMATS "hdf5|sesame|miluph"
enum { TABFILE_HDF5, TABFILE_SESAME, TABFILE_MILUPH };

/* tabfile_read: any of the formats, told apart by their content; checked. Errors name the file and
 * the line, in hdf5 the dataset or node. */
int tabfile_read(Table *t, const char *path, Err *err);

/* tabfile_write: appears whole or not at all; "-" is stdout. Text formats cannot have a density or
 * energy twice: the first of a pair is written. sesame needs an axis of temperatures, miluph one of
 * energies, else it is an error; what is absent is written as 0. */
int tabfile_write(const Table *t, const char *path, int format, Err *err);

/* tabfile_checksum: eight hexadecimal digits, the CRC-32 of the file's bytes (as gzip has it). */
int tabfile_checksum(const char *path, char sum[9], Err *err);

#endif
