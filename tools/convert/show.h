/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The formats that others only look at: CSV, VTK, H5Part and XDMF. */
#ifndef SHOW_H
#define SHOW_H

#include "sheet.h"

/* show_csv: one line a particle, names with units in the first. */
int show_csv(const Parts *p, const Sheet *s, const char *path, Err *err);

/* show_vtu: VTK's XML for unstructured grids, one vertex a particle, raw appended data. */
int show_vtu(const Parts *p, const Sheet *s, const char *path, Err *err);

/* show_h5part: H5Part, complete in itself: Step#0 ..., one-dimensional datasets. Begun with
 * show_h5part_open, a step at a time. */
typedef struct ShowSeries ShowSeries;
ShowSeries *show_h5part_open(const char *path, Err *err);
int show_h5part_add(ShowSeries *series, const Parts *p, const Sheet *s, Err *err);
int show_h5part_close(ShowSeries *series, int good, Err *err);

/* show_xdmf: XDMF 2 text that points into snapshots; no data of its own. Begun with
 * show_xdmf_open, a snapshot at a time. */
ShowSeries *show_xdmf_open(const char *path, Err *err);
int show_xdmf_add(ShowSeries *series, const Parts *p, const Sheet *s, const char *snapshot,
                  Err *err);
int show_xdmf_close(ShowSeries *series, int good, Err *err);

#endif
