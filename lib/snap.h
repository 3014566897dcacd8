/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Snapshots: Parts in HDF5, in the GADGET layout that yt, pynbody, h5py and (through links)
 * ParaView open. See docs/schema.md. Files are byte-identical for identical content: no dates, no
 * dataset times. A file appears under its name only when whole and synced. */
#ifndef SNAP_H
#define SNAP_H

#include "part.h"

/* snap_read: path, or "-" or NULL for stdin (spooled to an unlinked temporary file; a redirected
 * file is opened as it is). Errors name the file and the reason: not there, empty stream ("the
 * command before the pipe failed"), not HDF5, truncated, field of a wrong shape, type or unit,
 * newer format. A field that the schema does not know is carried through when it has one row a
 * particle and no pointers (strings of variable length, references); any other is an error, since
 * no tool could say which of its rows go with which particle. Values are not judged here: see
 * part_check. */
Parts *snap_read(const char *path, Err *err);

/* snap_read_some: the same, but of the particle fields only `members` that are there (names as in
 * fields.h, or the datasets of fields that the schema does not know; separated by blanks): neither
 * other fields nor flaws. For programs that write no snapshot. */
Parts *snap_read_some(const char *path, const char *members, Err *err);

/* snap_write: path, or "-" or NULL for stdout (refused when it is a terminal). checkpoint != 0 also
 * writes CHECKPOINT_FIELDS. Written to a temporary file beside path, fsync'ed and renamed; on
 * failure nothing is left behind. */
int snap_write(const Parts *p, const char *path, int checkpoint, Err *err);

/* snap_put_materials, snap_get_materials: the group /Materials of an open HDF5 file (a hid_t),
 * which other formats may hold too; an absent one leaves p without materials. */
int snap_put_materials(int64_t file, const Parts *p, Err *err);
int snap_get_materials(int64_t file, Parts *p, Err *err);

/* snap_series: writes DIR/run.h5part, the series of snapshots for ParaView: Step#k are external
 * links to files[k] (names relative to DIR) with the attribute TimeValue, which is the
 * snapshot's own; TimeValues lists all times [s]. Atomic. */
int snap_series(const char *dir, const char *const *files, const double *times, int n, Err *err);

#endif
