/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What test_cuda_backend compares the pair loops with: forms, kernels, dimensions, extra terms. */
#ifndef LOOP_CASES_H
#define LOOP_CASES_H

/* Settings of the extra pair terms. */
#define RICH                                                                                       \
  "pressure_form=product stress_form=squares form.xsph=0.5 form.diffusion=0.1 "                    \
  "stress.artificial=0.2 "                                                                         \
  "stress.spacing=0.5 force.x=0.1 viscosity.switch=cullen_dehnen"
#define RICH_TOO "viscosity.switch=morris_monaghan viscosity.balsara=true stress.artificial=0.2"

typedef struct {
  const char *integrator, *density, *strength, *kernel;
  int dimension;
  const char *more;
} LoopCase;
#define FLUID                                                                                      \
  "viscosity.kinematic=0.1 viscosity.bulk=0.1 viscosity.shakura_sunyaev=0.1 "                      \
  "viscosity.compression=0.5 heating.rate=1 heating.radius=0.5 heating.profile=gaussian"
static const LoopCase loop_cases[] = {
    {"integrator=leapfrog", "density=continuity", "strength.on=true", "kernel=wendland_c2", 3,
     RICH},
    {"integrator=leapfrog", "density=continuity", "strength.on=false", "kernel=quintic_spline", 2,
     RICH},
    {"integrator=leapfrog", "density=continuity", "strength.on=true", "kernel=wendland_c4", 1,
     RICH},
    {"integrator=leapfrog", "density=miscible", "strength.on=true", "kernel=cubic_spline", 3,
     RICH_TOO},
    {"integrator=leapfrog", "density=continuity", "strength.on=true", "kernel=wendland_c2", 3,
     NULL},
    {"integrator=leapfrog", "density=miscible_continuity", "strength.on=true",
     "kernel=cubic_spline", 3, RICH_TOO},
    {"integrator=leapfrog", "density=miscible_continuity", "strength.on=true", "kernel=wendland_c2",
     3, NULL},
    {"integrator=leapfrog", "density=miscible_continuity", "strength.on=false",
     "kernel=wendland_c4", 2, NULL},
    {"integrator=leapfrog", "density=miscible_continuity", "strength.on=true",
     "kernel=cubic_spline", 1, NULL},
    {"integrator=leapfrog", "form.shepard=true", "strength.on=true", "kernel=wendland_c2", 3, NULL},
    {"integrator=leapfrog", "form.shepard=true", "strength.on=true", "kernel=cubic_spline", 2,
     RICH},
    {"integrator=leapfrog", "form.shepard=true", "strength.on=true", "kernel=wendland_c2", 1, NULL},
    {"integrator=leapfrog", "density=sum", "strength.on=true", "kernel=wendland_c2", 3,
     "form.grad_h=true"},
    {"integrator=leapfrog", "density=miscible", "strength.on=false", "kernel=cubic_spline", 2,
     "form.grad_h=true smoothing.mode=neighbours smoothing.neighbours=26 " RICH_TOO},
    {"integrator=leapfrog", "density=sum", "strength.on=true", "kernel=wendland_c4", 1,
     "form.grad_h=true smoothing.mode=neighbours smoothing.neighbours=8"},
    {"integrator=leapfrog", "form.gradient=raw", "strength.on=true", "kernel=wendland_c2", 3, NULL},
    {"integrator=leapfrog", "density=sum", "strength.on=false", "kernel=cubic_spline", 3, NULL},
    {"integrator=leapfrog", "pressure_form=product", "strength.on=true", "kernel=wendland_c2", 3,
     NULL},
    {"integrator=leapfrog", "pressure_form=product", "strength.on=false", "kernel=wendland_c2", 2,
     NULL},
    {"integrator=leapfrog", "density=miscible", "strength.on=true", "kernel=wendland_c4", 3, NULL},
    {"integrator=leapfrog", "density=miscible", "strength.on=false", "kernel=wendland_c2", 2, NULL},
    {"integrator=leapfrog", "density=sum", "strength.on=true", "kernel=quintic_spline", 2, NULL},
    {"integrator=leapfrog", "density=sum", "strength.on=true", "kernel=cubic_spline", 1, NULL},
    {"integrator=leapfrog", "density=sum", "strength.on=false", "kernel=wendland_c2", 2, FLUID},
    {"integrator=leapfrog", "density=continuity", "strength.on=true", "kernel=wendland_c2", 3,
     FLUID},
    {"integrator=leapfrog", "density=continuity", "strength.on=false", "kernel=wendland_c2", 1,
     FLUID},
};

#endif
