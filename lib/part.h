/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Particles in memory: one array a field (NULL when absent), made from the table in fields.h, and
 * what belongs to them: time, materials, history, collision geometry, flaws, and the fields that
 * this version does not know. */
#ifndef PART_H
#define PART_H

#include <stddef.h>
#include <stdint.h>
#include "err.h"
#include "fields.h"

typedef struct {
  char name[64];
  char *text; /* the material's .cfg, whole */
} PartMaterial;

typedef struct {
  char name[64];
  double value;
} PartNumber; /* a named number: an attribute of /Collision, /Body or /Run */

typedef struct {
  char name[128]; /* dataset name under /PartType0 */
  int64_t type;   /* HDF5 native type id (hid_t), closed by part_free */
  int rank;       /* 1 to 4, the particles' own dimension included */
  int dim[3];     /* [rank-1] shape of a row */
  int width;      /* elements a row */
  int size;       /* bytes a row */
  double unit_si; /* factor to SI */
  char unit[64], meaning[256];
  unsigned char *data; /* [n][size] */
} PartExtra;

typedef struct {
  long n;
  int dimension;                                            /* 1, 2 or 3 */
  double time;                                              /* s */
#define PART_MEMBER(TYPE, MEMBER, WIDTH, ...) TYPE *MEMBER; /* [n][WIDTH] */
  ALL_FIELDS(PART_MEMBER)
#undef PART_MEMBER
  int32_t *nflaw; /* [n] FlawCount, or NULL */
  int64_t flaws;  /* sum of nflaw */
  double *flaw; /* [flaws] FlawThresholds, strain, ascending within a particle, in particle order */
  PartMaterial *material; /* [materials] */
  int materials;
  char **history; /* [histories] "command line\tversion" */
  int histories;
  char **parameter; /* [parameters] "key\tvalue\tdefault|given|used" lines of /Parameters */
  int parameters;
  PartNumber *collision; /* [collisions] attributes of /Collision */
  int collisions;
  PartNumber *body_info; /* [body_infos] attributes of /Body: Radius0, RadiusMax0, ... numbered by
                            body id */
  int body_infos;
  PartNumber *run; /* [runs] attributes of /Run: where a run of the solver stands */
  int runs;
  PointMass *point; /* [points] point masses */
  int points;
  long point_rows;  /* how many of the n rows, the last ones, stand for them (pointmass_rows) */
  PartExtra *extra; /* [extras] unknown fields, carried through */
  int extras;
} Parts;

/* The rows of fields.h as data, for loops over all fields: part_fields[0 .. part_field_count-1],
 * FIELDS first. */
typedef struct {
  const char *member, *name, *unit, *maker,
      *meaning;   /* name: of the dataset; maker: the program that makes it */
  char kind;      /* 'd' double, 'l' int64_t, 'i' int32_t */
  int width;      /* elements a row */
  int size;       /* bytes a row */
  int checkpoint; /* belongs to CHECKPOINT_FIELDS */
  size_t offset;  /* of the pointer in Parts */
} PartField;
extern const PartField part_fields[];
extern const int part_field_count;

/* part_field: the row of a field by its member name ("rho") or dataset name ("Density"); NULL when
 * there is none. */
const PartField *part_field(const char *name);

/* part_array: the array of a field, NULL when absent. part_set_array puts one there (what was there
 * is not freed). */
void *part_array(const Parts *p, const PartField *f);
void part_set_array(Parts *p, const PartField *f, void *array);

/* part_new: n particles with the mandatory arrays unset; dimension 3. All pointers NULL. NULL when
 * out of memory. */
Parts *part_new(long n);
void part_free(Parts *p);

/* part_add: makes sure that an array exists (zeroed when new). member: name as in fields.h, several
 * separated by blanks: part_add(p, "id x v m", err). Returns 0, or -1 for lack of memory or an
 * unknown name. */
int part_add(Parts *p, const char *members, Err *err);

/* part_add_extra: a field that the schema does not have, one zeroed double a particle, which every
 * program carries through; [p->n], NULL without memory. */
double *part_add_extra(Parts *p, const char *name, const char *unit, const char *meaning, Err *err);

/* part_need: all of these must be there ("nflaw" too); else -1 and "'a.h5' lacks field 'Damage'
 * (made by weibull)". */
int part_need(const Parts *p, const char *members, const char *file, Err *err);

/* part_check: validity of what is there: finite x v u rho, m > 0, h > 0, rho > 0, unique ids, mat <
 * materials, damage in 0..1, counts of flaws. The message names the field and the particle's id. */
int part_check(const Parts *p, const char *file, Err *err);

/* part_flaw_start: where the flaws of each particle start in flaw: [n+1], the last is their number.
 * Free it; NULL without memory. */
int64_t *part_flaw_start(const Parts *p);

/* part_select: the particles with keep[i] != 0, every field (flaws and unknown fields too); NULL on
 * error. */
Parts *part_select(const Parts *p, const unsigned char *keep, Err *err);

/* part_permute: row i of the result is row order[i]. In place. */
int part_permute(Parts *p, const long *order, Err *err);

/* part_join: a followed by b (for collide). Fields that only one of them has are filled with zeros
 * in the other (Distention: ones), unknown fields too; materials of the same name and text are
 * merged and mat of b renumbered. Ids of b that occur in a are an error, as are unequal dimensions
 * and unknown fields of the same name but another shape, type or unit. Time and named numbers are
 * a's; numbers that only b has are added, so rename Radius0 of b before. History and parameters of
 * b follow those of a, and so do its point masses. */
Parts *part_join(const Parts *a, const Parts *b, Err *err);

/* part_history: appends a command line. part_set_number / part_number: named numbers in /Collision
 * ("collision"), /Body ("body") or /Run ("run"); part_number returns NAN when it is not there.
 * /Run goes with a whole file only: part_select and part_join leave it out. Point masses stay. */
int part_history(Parts *p, const char *command_line, Err *err);
int part_set_number(Parts *p, const char *group, const char *name, double value, Err *err);
double part_number(const Parts *p, const char *group, const char *name);

/* part_add_material: name and text; returns its index (an equal one that is there already is
 * reused), or -1. */
int part_add_material(Parts *p, const char *name, const char *text, Err *err);

#endif
