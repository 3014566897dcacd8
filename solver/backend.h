/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A backend: a machine that holds the state and runs the passes. What is physics is in physics/ and
 * passes.h and is shared; what traverses (sort, tree, search, pair loops, gravity walk, reductions)
 * is written once per machine behind this struct. Run loop and integrators see nothing else. */
#ifndef BACKEND_H
#define BACKEND_H

#include "grad.h"
#include "param.h"
#include "passes.h"
#include "leave.h"

/* Sums over all particles in a fixed order, independent of threads. SI; energies in J. */
struct Sums {
  double mass, kinetic, internal, potential;
  double momentum[3], angular[3], centre[3]; /* kg m/s, kg m^2/s, m */
  double scale_momentum, scale_angular; /* sum m |v|, sum m |r x v|: what drifts are measured by */
  double
      outside[3]; /* particles outside their table: in density, above it and below it in energy */
  double held[2]; /* particles whose h is at its smallest, at its largest */
  double lifted;  /* J that energy_floor has added */
  double at_floor
      [3]; /* particles whose energy, density (within 1 %) or pressure is the least allowed */
};

/* The smallest time step that a criterion allows, which and to whom; the first particle in a bad
 * state. */
typedef struct {
  double dt;       /* s */
  int which;       /* enum of LIMIT_NAMES */
  int64_t id;      /* the particle, or -1 */
  double dilation; /* largest |div v| [1/s] */
  int64_t bad;     /* id of a particle that is not finite or not positive, or -1 */
  int bad_reason;  /* enum bad */
} Limits;

typedef struct {
  double start, spent; /* s */
  long calls;
  const char *name;
} BackendTimer;

enum {
  TIMER_ORDER,
  TIMER_SEARCH,
  TIMER_A,
  TIMER_LOCAL,
  TIMER_DENSITY,
  TIMER_B,
  TIMER_GRAVITY,
  TIMER_REDUCE,
  TIMERS
};

struct backend {
  const char *name;
  /* cards: how many devices there are for it; -1: this build lacks the backend. */
  int (*cards)(void);
  /* open: takes the particles over (they keep their row order in every file). close: frees all. */
  int (*open)(Sim *sim, const Parts *parts, Err *err);
  void (*close)(Sim *sim);
  /* store: the present state, on its way into parts (same n and row order as at open). fetch: the
   * rest of that way; another thread may call it while the run goes on, before the next store.
   * copy: bytes of an array of the state to the host, or back. */
  int (*store)(Sim *sim, Parts *parts, Err *err);
  int (*fetch)(Sim *sim, Parts *parts, Err *err);
  int (*copy)(Sim *sim, void *to, const void *from, size_t bytes, Err *err);
  /* search: orders the particles, builds the tree at x and the neighbour lists for x and for y. */
  int (*search)(Sim *sim, Err *err);
  /* pass: one of passes.h over all particles, and points_pass. */
  void (*pass)(Sim *sim, int pass, const Step *step);
  /* gradient: loop A at y with v, ha and volumes m/rhoa: divv and (solids) g, cm. density: kernel
   * sums at x: rho, delta, and rhoa, the mean of rho before and after. force: loop B at x with
   * vp: acc, du, signal, nngb. gravity: when it is due sets pull and phi; adds pull to acc; then
   * points_exchange. */
  void (*gradient)(Sim *sim);
  void (*density)(Sim *sim);
  void (*force)(Sim *sim);
  int (*gravity)(Sim *sim, Err *err);
  /* leaving: how many particles the test sends away. keep: only the particles kept[n], ascending,
   * stay, in this order; what no search moves is lost. */
  int (*leaving)(Sim *sim, const Leave *test, long *count, Err *err);
  int (*keep)(Sim *sim, const uint32_t *kept, long n, Err *err);
  /* points: adds the pull of these masses at x to acc; reaction [field->n]: what each does. */
  int (*points)(Sim *sim, const PointField *field, PointReaction *reaction, Err *err);
  /* Reductions (reduce.h). bodies: centre, velocity and spin of each body id below BODIES, for
   * damping. error: the largest of rk2-adaptive for a tolerance of 1. Failures of steps that return
   * nothing are reported here, by search, gravity or store. */
  int (*limits)(Sim *sim, const Step *step, Limits *out, Err *err);
  int (*sums)(Sim *sim, Sums *out, Err *err);
  int (*bodies)(Sim *sim, Step *step, Err *err);
  /* change: the largest change of pull between the last two evaluations, over its mean size. */
  int (*change)(Sim *sim, double *relative, Err *err);
  int (*error)(Sim *sim, const Step *step, double *worst, Err *err);
};

extern const struct backend backend_cpu, backend_cuda;

struct Sim {
  const struct backend *b;
  Param par;
  Material *material; /* [materials], host */
  int materials;
  int solid;   /* any material with a shear modulus, and strength on */
  int fluid;   /* any other */
  int viscous; /* physical viscosity */
  int rich;    /* pair terms of pair_rich.h */
  int tensor;  /* forces need the velocity gradient and a stress: solid, viscous or rich */
  PairMore more;
  int rare;     /* any material with laws that few runs need (material_rare) */
  int porous;   /* any material with pores */
  int crushes;  /* any whose pores begin to crush at a pressure */
  int heated;   /* any material whose strength has a temperature of its own, and strength on */
  int central;  /* laws that depend on the distance from a centre */
  int miscible; /* the number-density form */
  Bounds bounds;
  Hold hold;
  State s;
  void *own;       /* the backend's */
  int card;        /* which of the backend's devices */
  int profile;     /* the timers are wanted */
  char about[256]; /* the machine, as the backend describes it */
  double time, dt; /* s; dt: the next step as the criteria allow */
  long step;
  /* gravity.every: whether this step ends with an evaluation of gravity; steps from the last one to
   * the next, as planned, and so far; the length of these and for how long it has kicked [s] */
  int pull_due, outer_steps, outer;
  double outer_time, outer_kick;
  /* gravity.tolerance: the time until the next evaluation; how much gravity changed between the
   * last two, over its mean size, and in what time */
  double outer_span, pull_change, pull_time;
  PointMasses points;
  Gone gone;         /* what has left */
  int late;          /* the laws of the late stage are in force (late.h) */
  double late_speed; /* largest sound speed of matter softened by it [m/s] */
  double stiffest;   /* largest bulk modulus of a material [Pa] */
  double dilation;   /* largest |div v| as the last look at the limits had it [1/s] */
  int slots, memory; /* of the integrator: saved states, rates of the step before */
  double dt_before;  /* length of the last step [s]; 0: there is none */
  BackendTimer timer[TIMERS];
};

/* rich_open: sim->rich and sim->more, from the settings and the particles (par.spacing, where it is
 * 0). rich_step: its part of a Step. rich_idle: whether a field is of terms that this run has not.
 * rich_fields: the names of those fields that a checkpoint needs, a space before each. */
enum { RICH_NAMES = 64 };
void rich_open(Sim *sim, const Parts *parts);
Rich rich_step(const Sim *sim);
int rich_idle(const Sim *sim, const char *member);
const char *rich_fields(const Sim *sim, char names[RICH_NAMES]);

/* backend_find: what "auto", "cpu", "cuda" or "cuda:K" means here; auto is a card when there is
 * one. NULL with a message. */
const struct backend *backend_find(const char *device, int *card, Err *err);

/* backend_idle: whether no pass of this run reads or writes the field of the state by that name: no
 * backend holds an array for it. */
int backend_idle(const Sim *sim, const char *member);

/* backend_range: the range of h into the state. backend_pair: what pairs share. */
void backend_range(Sim *sim);
PairRun backend_pair(const Sim *sim, int dimension);

/* backend_grad: what form.grad_h sums with. */
Grad backend_grad(const Sim *sim);

/* grad_open: with form.grad_h brings each h of a fresh state to where density and h agree. */
int grad_open(Sim *sim, Err *err);

/* backend_look: the state of one particle as text, for error messages. */
void backend_look(Sim *sim, int64_t id, char *text, size_t size);

/* backend_begin, backend_end: bracket a pass by the wall clock, for --profile. */
void backend_begin(Sim *sim, int timer);
void backend_end(Sim *sim, int timer);

#endif
