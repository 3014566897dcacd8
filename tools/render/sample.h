/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Three ways to see particles: each fills a window of samples with the value shown and a
 * brightness. */
#ifndef SAMPLE_H
#define SAMPLE_H

#include "camera.h"
#include "field.h"

typedef struct {
  int w, h, stride; /* px */
  float *value;     /* [h][stride], NAN where nothing is seen */
  float *shade;     /* [h][stride], 0..1 */
} Window;

/* slice_sample: SPH interpolation sum_j m_j/rho_j A_j W / sum_j m_j/rho_j W on the cutting plane,
 * inside of the matter (where the denominator, 1 in the bulk, exceeds 1/2, or within a particle on
 * its own); kinds by the particle that weighs most. */
int slice_sample(Window *win, const Parts *p, const Field *f, const Camera *c, Err *err);

/* What is removed: the space in front of all of the planes normal . x = 0 through the centre (0 of
 * them: nothing, NULL: what lies before the cutting plane). Each normal has a component towards the
 * viewer. */
enum { CUT_PLANES = 3 };
typedef struct {
  double normal[CUT_PLANES][3];
  int planes;
} Cut;

/* cut_sample: particles as shaded spheres; those that a face of the cut meets are cut flat. */
int cut_sample(Window *win, const Parts *p, const Field *f, const Camera *c, const Cut *cut,
               Err *err);

/* project_sample: along the line of sight: sum_j m_j int W dz for FIELD_COLUMN, else the
 * mass-weighted mean of the field, where the column is more than 1e-4 of its largest value. */
int project_sample(Window *win, const Parts *p, const Field *f, const Camera *c, Err *err);

#endif
