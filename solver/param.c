/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table of run settings and what is made from it. */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include "../physics/kernel.h"
#include "../lib/unit.h"
#include "integrator.h"
#include "param.h"

/* Words of a list, each with a bar in front; the rows skip the first bar. */
#define WORD_KERNEL(CAPITAL, NAME, ...) "|" #NAME
#define WORD_INTEGRATOR(WORD, NAME)     "|" WORD
static const char kernel_words[] = KERNELS(WORD_KERNEL);
static const char integrator_words[] = INTEGRATORS(WORD_INTEGRATOR);

typedef struct {
  const char *name; /* group in run.cfg; "" for the top level */
  const CfgRow *rows;
  int n;
} Group;

#define AT(MEMBER) offsetof(Param, MEMBER)
#define ANY        1, 0

/* clang-format off */
static const CfgRow top[] = {
  {"integrator", CFG_CHOICE, AT(integrator), integrator_words + 1, "leapfrog", ANY, "time integration"},
  {"kernel", CFG_CHOICE, AT(kernel), kernel_words + 1, "wendland_c2", ANY, "SPH kernel"},
  {"precision", CFG_CHOICE, AT(precision), "mixed|double", "mixed", ANY,
   "mixed: pair terms in single precision between exact differences (on the CPU gravity's only), the rest in double"},
  {"density", CFG_CHOICE, AT(density), "continuity|sum|miscible|miscible_continuity", "continuity", ANY,
   "continuity equation, kernel sum, kernel sum of the number density, or continuity equation of the number density"},
  {"pressure_form", CFG_CHOICE, AT(pressure), "squares|product", "squares", ANY,
   "p_i/rho_i^2 + p_j/rho_j^2 (001 eq. 30), or (p_i + p_j)/(rho_i rho_j): layers of other density stay at rest (continuity)"},
  {"stress_form", CFG_CHOICE, AT(stress_form), "squares|product", "product", ANY,
   "S_i C_i/rho_i^2 + S_j C_j/rho_j^2, or (S_i C_i + S_j C_j)/(rho_i rho_j)"},
  {"density_floor", CFG_REAL, AT(density_floor), "1", "1", 0, 1e6,
   "smallest density, in units of what a lone particle's own kernel makes, m W(0)"},
  {"energy", CFG_CHOICE, AT(energy), "full|isentropic|frozen", "full", ANY,
   "energy equation: all work, compression only (frozen entropy), or none"},
  {"energy_floor", CFG_REAL, AT(energy_floor), "J/kg", "-1e300", ANY, "smallest specific internal energy"},
  {"pressure_floor", CFG_REAL, AT(pressure_floor), "Pa", "-1e300", ANY, "smallest pressure"},
  {"outer_pressure", CFG_REAL, AT(outer_pressure), "Pa", "0", 0, 1e30, "pressure outside, on free surfaces; E + p V is kept, not E"},
};
static const CfgRow strength[] = {
  {"on", CFG_BOOL, AT(strength), NULL, "true", ANY, "deviatoric stress of materials with a shear modulus"},
  {"damage", CFG_BOOL, AT(damage), NULL, "true", ANY, "brittle damage of materials that have a law for it and flaws"},
};
static const CfgRow gravity[] = {
  {"method", CFG_CHOICE, AT(gravity), "none|tree|direct", "tree", ANY, "self-gravity: Barnes-Hut with quadrupoles, or direct sum"},
  {"theta", CFG_REAL, AT(theta), "1", "0.7", 0, 1.5, "opening angle: node edge over smallest distance"},
  {"G", CFG_REAL, AT(G), "m^3/kg/s^2", "6.67430e-11", 0, 1e30, "constant of gravity (CODATA 2018); 1 in code units"},
  {"softening", CFG_CHOICE, AT(softening), "spline|plummer", "spline", ANY,
   "of self-gravity: Newton's beyond the support of a spline, or Plummer's, G m/sqrt(r^2 + epsilon^2)"},
  {"epsilon", CFG_REAL, AT(epsilon), "m", "0", 0, 1e150,
   "one softening length of all particles: that of Plummer, or a third of the spline's support; 0: that is each pair's h"},
  {"tolerance", CFG_REAL, AT(gravity_tolerance), "1", "0", 0, 1,
   "gravity anew when that of some particle will have changed by this part of the mean of all, at the latest after `every` steps; 0: then"},
  {"every", CFG_INT, AT(gravity_every), NULL, "1", 1, 1000,
   "steps between evaluations of gravity, which then kicks for all of them; outputs and log lines evaluate it too (leapfrog)"},
};
static const CfgRow viscosity[] = {
  {"alpha", CFG_REAL, AT(alpha), "1", "0.5", 0, 100,
   "linear artificial viscosity of 001 eq. 32, h the full support: 0.5 is the 1 of codes with half of it"},
  {"beta", CFG_REAL, AT(beta), "1", "0.5", 0, 100,
   "quadratic artificial viscosity: 0.5 is the 2 of codes with half the support"},
  {"switch", CFG_CHOICE, AT(viscosity_switch), "none|morris_monaghan|cullen_dehnen", "none", ANY,
   "artificial viscosity of each particle between `least` and 1 times alpha and beta, as shocks need it"},
  {"least", CFG_REAL, AT(viscosity_least), "1", "0.1", 0, 1, "smallest share of alpha and beta with a switch"},
  {"balsara", CFG_BOOL, AT(balsara), NULL, "false", ANY, "less artificial viscosity where matter turns or shears (Balsara 1995)"},
  {"kinematic", CFG_REAL, AT(shear), "m^2/s", "0", 0, 1e300, "constant kinematic viscosity of fluids (Navier-Stokes)"},
  {"shakura_sunyaev", CFG_REAL, AT(shakura), "1", "0", 0, 10,
   "alpha of a kinematic viscosity alpha c H of fluids, H = aspect times the distance from the centre (disk.point)"},
  {"aspect", CFG_REAL, AT(aspect), "1", "0.05", 0, 10, "H/r for shakura_sunyaev"},
  {"bulk", CFG_REAL, AT(bulk), "m^2/s", "0", 0, 1e300, "constant kinematic bulk viscosity of fluids"},
  {"compression", CFG_REAL, AT(compression), "1", "0", 0, 100,
   "f of a kinematic bulk viscosity f h^2 |div v| of fluids under compression (Kley 1999: 0.5)"},
};
static const CfgRow form[] = {
  {"gradient", CFG_CHOICE, AT(gradient_raw), "corrected|raw", "corrected", ANY,
   "velocity gradient with the tensorial correction (001 eq. 42-44), exact for linear fields, and its adjoint in the stress; or without"},
  {"shepard", CFG_BOOL, AT(shepard), NULL, "false", ANY,
   "kernels of pairs normalised against missing neighbours at surfaces: W_ij/sqrt(theta_i theta_j), theta_i = sum V_j W_ij (Shepard)"},
  {"grad_h", CFG_BOOL, AT(grad_h), NULL, "false", ANY,
   "h = eta (m/rho)^(1/D) solved with the summed density, and its gradient in the forces (Springel & Hernquist 2002; Price 2012)"},
  {"xsph", CFG_REAL, AT(xsph), "1", "0", 0, 1, "particles move with the mean velocity around, by this factor (001 eq. 40)"},
  {"diffusion", CFG_REAL, AT(diffusion), "1", "0", 0, 1,
   "delta of the diffusion of density of Molteni & Colagrossi (2009), h the full support: 0.05 is the 0.1 of codes with half of it"},
};
static const CfgRow stress[] = {
  {"artificial", CFG_REAL, AT(artificial), "1", "0", 0, 10,
   "factor eps of the artificial stress against clumping in tension (001 eq. 35-38: 0.2)"},
  {"exponent", CFG_INT, AT(stress_exponent), NULL, "4", 0, 15, "n: it goes with (W/W at the mean distance of particles)^n"},
  {"spacing", CFG_REAL, AT(spacing), "1", "0", 0, 1, "mean distance of particles over h; 0: (m/rho)^(1/D)/h of the input"},
};
static const CfgRow force[] = {
  {"x", CFG_REAL, AT(force[0]), "m/s^2", "0", ANY, "constant body force along x"},
  {"y", CFG_REAL, AT(force[1]), "m/s^2", "0", ANY, "along y"},
  {"z", CFG_REAL, AT(force[2]), "m/s^2", "0", ANY, "along z"},
};
static const CfgRow disk[] = {
  {"point", CFG_INT, AT(disk_point), NULL, "1", 0, PARAM_POINTS,
   "which point mass (1, 2, ...) is the centre for local_isothermal and shakura_sunyaev; 0, or without point masses: the origin"},
};
static const CfgRow heating[] = {
  {"rate", CFG_REAL, AT(deposit), "W/kg", "0", ANY, "energy from outside at the centre; 0: none"},
  {"profile", CFG_CHOICE, AT(deposit_profile), "uniform|gaussian", "uniform", ANY,
   "rate within the radius, or rate exp(-r^2/(2 radius^2))"},
  {"radius", CFG_REAL, AT(deposit_radius), "m", "0", 0, 1e300, "of the heated region; 0: everywhere"},
  {"axis", CFG_CHOICE, AT(deposit_axis), "none|x|y|z", "none", ANY, "a ball, or a beam along an axis through the centre"},
  {"x", CFG_REAL, AT(deposit_centre[0]), "m", "0", ANY, "centre"},
  {"y", CFG_REAL, AT(deposit_centre[1]), "m", "0", ANY, "centre"},
  {"z", CFG_REAL, AT(deposit_centre[2]), "m", "0", ANY, "centre"},
  {"begin", CFG_REAL, AT(deposit_begin), "s", "-1e300", ANY, "from this time on"},
  {"end", CFG_REAL, AT(deposit_end), "s", "1e300", ANY, "to this time"},
};
static const CfgRow smoothing[] = {
  {"mode", CFG_CHOICE, AT(smoothing), "fixed|density|neighbours|overcorrected", "density", ANY,
   "h constant, following the density, also pulled to the number of neighbours, or pushed back where they are too few or many"},
  {"neighbours", CFG_REAL, AT(neighbours), "1", "57", 1, 1000, "wanted number of neighbours for modes neighbours and overcorrected"},
  {"fewest", CFG_REAL, AT(fewest), "1", "0.666666666666667", 0, 1, "of these: below it mode overcorrected lets h grow (004: 2/3)"},
  {"most", CFG_REAL, AT(most), "1", "1.66666666666667", 1, 100, "of these: above it mode overcorrected lets h shrink (004: 5/3)"},
  {"width", CFG_REAL, AT(width), "1", "5", 0.1, 1000, "neighbours over which mode overcorrected sets in"},
  {"min", CFG_REAL, AT(h_min), "1", "0.2", 0, 1, "smallest h, in units of the smallest of the input"},
  {"max", CFG_REAL, AT(h_max), "1", "5", 1, 1e6, "largest h, in units of the largest of the input"},
};
static const CfgRow step[] = {
  {"cfl", CFG_REAL, AT(cfl), "1", "0.4", 1e-6, 2, "of h over the largest signal velocity c_i + c_j - 3 v_ij.r_ij/r"},
  {"acceleration", CFG_REAL, AT(step_acceleration), "1", "0.25", 1e-6, 2, "of sqrt(h/a)"},
  {"density", CFG_REAL, AT(step_density), "1", "0.3", 1e-6, 10, "of 1/|div v|"},
  {"error", CFG_REAL, AT(step_error), "1", "1e-4", 1e-15, 1, "tolerance of rk2-adaptive"},
  {"growth", CFG_REAL, AT(step_growth), "1", "2", 1, 100, "most that a step of rk2-adaptive may grow by after one that it kept"},
  {"energy", CFG_REAL, AT(step_energy), "1", "0", 0, 10, "of (u + energy_least)/|du/dt| where u falls; 0: no such limit"},
  {"smoothing", CFG_REAL, AT(step_smoothing), "1", "0", 0, 10, "of h/|dh/dt|; 0: no such limit"},
  {"stress", CFG_REAL, AT(step_stress), "1", "0", 0, 10, "of (|S| + stress_least)/|dS/dt|; 0: no such limit"},
  {"damage", CFG_REAL, AT(step_damage), "1", "0", 0, 10, "of (D^(1/3) + damage_least)/|d(D^(1/3))/dt|; 0: no such limit"},
  {"distention", CFG_REAL, AT(step_distention), "1", "0", 0, 100,
   "largest change of the distention in a step (rk2-adaptive repeats a step that exceeds it); 0: no such limit"},
  {"pressure", CFG_REAL, AT(step_pressure), "1", "0", 0, 1000,
   "largest change of p in a step, of that at which pores begin to crush; 0: no such limit"},
  {"energy_least", CFG_REAL, AT(energy_least), "J/kg", "100", 0, 1e300, "added to u in step.energy"},
  {"stress_least", CFG_REAL, AT(stress_least), "Pa", "1e4", 0, 1e300, "added to |S| in step.stress"},
  {"damage_least", CFG_REAL, AT(damage_least), "1", "0.01", 0, 1, "added to D^(1/3) in step.damage"},
  {"first", CFG_REAL, AT(step_first), "s", "0", 0, 1e300, "largest first step; 0: no such limit"},
  {"min", CFG_REAL, AT(step_min), "s", "1e-30", 0, 1e300, "a step below this stops the run"},
  {"max", CFG_REAL, AT(step_max), "s", "0", 0, 1e300, "largest step; 0: no such limit"},
  {"points", CFG_REAL, AT(step_points), "1", "0.03", 1e-6, 1,
   "of the least sqrt(r^3/(G m)) between two point masses; of heun-rk4 their substep, its step may have eight"},
};
static const CfgRow spin[] = {
  {"rate", CFG_REAL, AT(spin_rate), "1/s", "0", 0, 1e300, "torque on each body: d(omega)/dt = rate (omega_target - omega); 0: none"},
  {"period", CFG_REAL, AT(spin_period), "s", "0", -1e300, 1e300, "of omega_target, negative against the axis; 0: no rotation"},
  {"axis", CFG_VECTOR, AT(spin_axis), "1", "0,0,1", ANY, "direction of omega_target"},
};
static const CfgRow late[] = {
  {"time", CFG_REAL, AT(late_time), "s", "0", -1e300, 1e300, "simulated time from which the late stage lasts; 0 is the contact"},
  {"bulk_modulus", CFG_REAL, AT(late_bulk), "Pa", "0", 0, 1e30,
   "of all stiffer matter in the late stage, p = K (rho/rho0 - 1); 0: no such stage"},
  {"poisson", CFG_REAL, AT(late_poisson), "1", "0.25", 0, 0.5, "Poisson's ratio, from which their shear modulus follows"},
  {"rho_min", CFG_REAL, AT(late_rho_min), "1", "1", 0, 1, "no tension below rho_min x rho0; 1: none at all"},
};
static const CfgRow error[] = {
  {"position", CFG_REAL, AT(error_position), "1", "1", 0, 1e6, "weight of the error of x over h against step.error; 0: not controlled"},
  {"velocity", CFG_REAL, AT(error_velocity), "1", "1", 0, 1e6, "of v over the speed of sound"},
  {"density", CFG_REAL, AT(error_density), "1", "1", 0, 1e6, "of rho over itself"},
  {"energy", CFG_REAL, AT(error_energy), "1", "1", 0, 1e6, "of u over |u| + c^2"},
  {"stress", CFG_REAL, AT(error_stress), "1", "1", 0, 1e6, "of S over rho c^2"},
  {"damage", CFG_REAL, AT(error_damage), "1", "1", 0, 1e6, "of D^(1/3)"},
};
static const CfgRow damping[] = {
  {"rate", CFG_REAL, AT(damping), "1/s", "0", 0, 1e300, "dv/dt = -rate (v - v_frame), in the co-rotating frame of each body"},
  {"radial", CFG_BOOL, AT(damping_radial), NULL, "false", ANY, "damp the radial component only"},
};
#define FACES "open|periodic|mirror|mirror_low|mirror_high|no_slip|no_slip_low|no_slip_high"
static const CfgRow boundary[] = {
  {"x", CFG_CHOICE, AT(faces[0]), FACES, "open", ANY, "faces across x: none, periodic, mirrors or no-slip walls at both or at one"},
  {"y", CFG_CHOICE, AT(faces[1]), FACES, "open", ANY, "the same across y"},
  {"z", CFG_CHOICE, AT(faces[2]), FACES, "open", ANY, "the same across z"},
  {"low", CFG_VECTOR, AT(low), "m", "0,0,0", ANY, "where the lower faces are"},
  {"high", CFG_VECTOR, AT(high), "m", "0,0,0", ANY, "where the upper faces are"},
};
#define WALL(K, WHAT) {"body" #K, CFG_TEXT, AT(wall[K]), NULL, "free", ANY, WHAT}
static const CfgRow walls[] = {
  WALL(0, "particles of body 0: free, held, or moved at a velocity X,Y,Z [m/s] that nothing changes"),
  WALL(1, "the same of body 1"), WALL(2, "the same"), WALL(3, "the same"), WALL(4, "the same"),
  WALL(5, "the same"), WALL(6, "the same"), WALL(7, "the same"),
};
static const CfgRow layer[] = {
  {"low", CFG_VECTOR, AT(layer_low), "m", "0,0,0", 0, 1e300,
   "width of a layer before each lower face of boundary that swallows waves; 0: none"},
  {"high", CFG_VECTOR, AT(layer_high), "m", "0,0,0", 0, 1e300, "the same before the upper faces"},
  {"strength", CFG_REAL, AT(layer_strength), "1", "7", 0, 1e3,
   "damping rate at the face, in units of the wave speed over the width; from the inner side on it grows linearly"},
};
static const CfgRow watch[] = {
  {"viscous_work", CFG_BOOL, AT(viscous_work), NULL, "false", ANY,
   "add up the heat that viscosity makes of each particle (ViscousWork): shock heating"},
};
static const CfgRow guard[] = {
  {"energy", CFG_REAL, AT(guard_energy), "1", "0", 0, 1e300,
   "a run stops when its energy has drifted by more than this share of E_kinetic + |E_internal| + |E_potential|; 0: never"},
  {"angular_momentum", CFG_REAL, AT(guard_angular), "1", "0", 0, 1e300, "the same of L, as a share of sum m |r x v|"},
  {"momentum", CFG_REAL, AT(guard_momentum), "1", "0", 0, 1e300, "the same of p, as a share of sum m |v|"},
};
static const CfgRow output[] = {
  {"log_every", CFG_INT, AT(log_every), NULL, "10", 1, 1e9, "steps between lines of conserved.tsv"},
  {"checkpoint_every", CFG_REAL, AT(checkpoint_every), "s", "600", 0, 1e300, "wall-clock time between checkpoints; 0: after every step"},
};
static const CfgRow analysis[] = {
  {"every", CFG_REAL, AT(analysis_every), "s", "0", 0, 1e300,
   "simulated time between lines of bound.tsv, the bound bodies that clumps finds; 0: none"},
  {"method", CFG_CHOICE, AT(analysis_method), "potential|grow", "potential", ANY, "as clumps --method"},
  {"criterion", CFG_CHOICE, AT(analysis_criterion), "kinetic|thermal|enthalpy", "kinetic", ANY, "as clumps --criterion"},
  {"points", CFG_BOOL, AT(analysis_points), NULL, "true", ANY, "point masses hold bodies, too, and count in all masses"},
  {"min_particles", CFG_INT, AT(analysis_least), NULL, "20", 2, 1e9, "smallest body"},
  {"link", CFG_REAL, AT(analysis_link), "1", "1", 1e-6, 100, "potential: friends when r_ij < link (h_i + h_j)/2"},
  {"theta", CFG_REAL, AT(analysis_theta), "1", "0.7", 0, 1, "opening angle of the analysis' own gravity tree"},
  {"max_virial", CFG_REAL, AT(analysis_virial), "1", "0", 0, 1e300,
   "search nothing while -2 E_kin/E_pot of the system is above this (say 3); 0: always search"},
  {"converged", CFG_REAL, AT(analysis_converged), "1", "0", 0, 1,
   "end the run when M_1, M_2 and M_bound have stayed within this part of the total mass for `window` lines; 0: do not"},
  {"window", CFG_INT, AT(analysis_window), NULL, "10", 2, 1000, "lines of bound.tsv that must agree"},
  {"after", CFG_REAL, AT(analysis_after), "s", "0", -1e300, 1e300, "time from which lines count for `converged`; 0 is the contact"},
};
static const CfgRow sink[] = {
  {"rule", CFG_CHOICE, AT(sink_bound), "all|bound", "all", ANY,
   "which of the particles within its radius a sink takes: all, or what is bound and slower around it than a circular orbit at the radius"},
  {"every", CFG_INT, AT(sink_every), NULL, "1", 1, 1e9, "steps between looks for what sinks take"},
};
static const CfgRow escape[] = {
  {"distance", CFG_REAL, AT(escape_distance), "m", "0", 0, 1e150, "particles further away go to escaped.h5; 0: none do"},
  {"from", CFG_CHOICE, AT(escape_from), "centre|origin|point|deepest", "centre", ANY,
   "away from the centre of mass of all, the origin at rest, the first point mass, or the particle deepest in the potential"},
  {"unbound", CFG_BOOL, AT(escape_unbound), NULL, "true", ANY, "only with v^2/2 + phi > 0, v as seen from there"},
  {"every", CFG_INT, AT(escape_every), NULL, "10", 1, 1e9, "steps between looks for what escapes"},
};
/* Each of the list point_masses. */
#define OF(MEMBER) offsetof(PointMass, MEMBER)
static const CfgRow point[] = {
  {"mass", CFG_REAL, OF(m), "kg", NULL, 0, 1e300, "a point mass: a star, a planet, a sink; the list has one group each"},
  {"position", CFG_VECTOR, OF(x), "m", "0,0,0", ANY, "three lengths"},
  {"velocity", CFG_VECTOR, OF(v), "m/s", "0,0,0", ANY, "three speeds"},
  {"softening", CFG_REAL, OF(h), "m", "0", 0, 1e300, "its pull is softened within this distance, as between particles; 0: nowhere"},
  {"radius", CFG_REAL, OF(radius), "m", "0", 0, 1e150, "of the sink: it takes particles that come this close; 0: none"},
  {"fixed", CFG_BOOL, OF(fixed), NULL, "false", ANY, "it stays where it is"},
  {"deaf", CFG_BOOL, OF(deaf), NULL, "false", ANY, "only other point masses pull on it, so momentum is not kept"},
};
enum { POINT_ROWS = sizeof point / sizeof *point };
/* clang-format on */

#define POINT_LIST "point_masses"
#define GROUP(NAME, ROWS)                                                                          \
  {                                                                                                \
    NAME, ROWS, (int)(sizeof(ROWS) / sizeof *(ROWS))                                               \
  }
static const Group groups[] = {GROUP("", top),
                               GROUP("strength", strength),
                               GROUP("gravity", gravity),
                               GROUP("viscosity", viscosity),
                               GROUP("form", form),
                               GROUP("stress", stress),
                               GROUP("force", force),
                               GROUP("disk", disk),
                               GROUP("heating", heating),
                               GROUP("smoothing", smoothing),
                               GROUP("step", step),
                               GROUP("error", error),
                               GROUP("late", late),
                               GROUP("damping", damping),
                               GROUP("spin", spin),
                               GROUP("boundary", boundary),
                               GROUP("walls", walls),
                               GROUP("layer", layer),
                               GROUP("sink", sink),
                               GROUP("escape", escape),
                               GROUP("watch", watch),
                               GROUP("guard", guard),
                               GROUP("output", output),
                               GROUP("analysis", analysis)};
enum { GROUPS = sizeof groups / sizeof *groups };

void param_defaults(Param *p)
{
  config_t empty;
  Err err;
  memset(p, 0, sizeof *p);
  config_init(&empty);
  for (int g = 0; g < GROUPS; g++)
    if (cfg_read(config_root_setting(&empty), groups[g].rows, groups[g].n, p, NULL, 0, "defaults",
                 &err))
      err_die("%s", err.text); /* a default of the table itself is wrong */
  config_destroy(&empty);
}

static int read_points(Param *p, const config_t *cfg, const char *path, Err *err)
{
  const config_setting_t *s = config_lookup(cfg, POINT_LIST);
  if (!s) return 0;
  if (!config_setting_is_list(s))
    return cfg_where(err, s, path, "'" POINT_LIST "' must be a list ( { ... }, { ... } )");
  if ((p->points = config_setting_length(s)) > PARAM_POINTS)
    return cfg_where(err, s, path, "%d point masses, a run takes %d", p->points, PARAM_POINTS);
  for (int k = 0; k < p->points; k++) {
    const config_setting_t *e = config_setting_get_elem(s, (unsigned)k);
    if (!config_setting_is_group(e))
      return cfg_where(err, e, path, "'" POINT_LIST "' must hold groups { ... }");
    if (cfg_read(e, point, POINT_ROWS, &p->point[k], NULL, 0, path, err)) return -1;
  }
  return 0;
}

int param_read(Param *p, const char *path, Err *err)
{
  const char *names[GROUPS] = {POINT_LIST};
  config_t cfg;
  int bad = 0;
  param_defaults(p);
  if (cfg_open(&cfg, path, err)) return -1;
  for (int g = 1; g < GROUPS; g++) names[g] = groups[g].name;
  bad =
      cfg_read(config_root_setting(&cfg), groups[0].rows, groups[0].n, p, names, GROUPS, path, err);
  for (int g = 1; g < GROUPS && !bad; g++) {
    const config_setting_t *s = config_lookup(&cfg, groups[g].name);
    if (s && !config_setting_is_group(s))
      bad = cfg_where(err, s, path, "'%s' must be a group { ... }", groups[g].name);
    else if (s)
      bad = cfg_read(s, groups[g].rows, groups[g].n, p, NULL, 0, path, err);
  }
  bad = bad || read_points(p, &cfg, path, err);
  config_destroy(&cfg);
  return bad ? -1 : 0;
}

int param_set(Param *p, const char *assignment, Err *err)
{
  const char *equals = strchr(assignment, '='), *names[GROUPS];
  char key[128], *dot, *name;
  if (!equals || equals == assignment || (size_t)(equals - assignment) >= sizeof key)
    return err_set(err, "'%s' is not of the form key=value", assignment);
  memcpy(key, assignment, (size_t)(equals - assignment));
  key[equals - assignment] = 0;
  dot = strchr(key, '.');
  name = dot ? dot + 1 : key;
  if (dot) *dot = 0;
  if (strcmp(key, POINT_LIST) == 0)
    return err_set(err, "'" POINT_LIST "' is a list and can only be given in a file");
  for (int g = 0; g < GROUPS; g++) {
    if (strcmp(dot ? key : "", groups[g].name) == 0)
      return cfg_set(groups[g].rows, groups[g].n, p, name, equals + 1, err);
    names[g] = groups[g].name;
  }
  name = (char *)unit_nearest(key, names + 1, GROUPS - 1);
  return err_set(err, "unknown group '%s'%s%s%s", key, name ? " (did you mean '" : "",
                 name ? name : "", name ? "'?)" : "");
}

const char *param_text(const Param *p, const char *key, char *buf, int size)
{
  for (int g = 0; g < GROUPS; g++) {
    size_t length = strlen(groups[g].name);
    if (strncmp(key, groups[g].name, length) || (length && key[length] != '.')) continue;
    for (int r = 0; r < groups[g].n; r++)
      if (strcmp(key + length + (length > 0), groups[g].rows[r].name) == 0)
        return cfg_text(&groups[g].rows[r], p, buf, size);
  }
  return NULL;
}

/* Lines `prefix.key value given|default` of all rows; standard NULL: all are given. */
static int record_rows(Parts *parts, const char *prefix, const CfgRow *rows, int n,
                       const void *from, const void *standard, Err *err)
{
  char value[128], other[128] = "", line[512];
  char **grown = realloc(parts->parameter, (size_t)(parts->parameters + n) * sizeof *grown);
  if (!grown) return err_set(err, "not enough memory");
  parts->parameter = grown;
  for (int r = 0; r < n; r++) {
    cfg_text(&rows[r], from, value, sizeof value);
    if (standard) cfg_text(&rows[r], standard, other, sizeof other);
    snprintf(line, sizeof line, "%s%s%s\t%s\t%s", prefix, *prefix ? "." : "", rows[r].name, value,
             strcmp(value, other) ? "given" : "default");
    if (!(parts->parameter[parts->parameters] = strdup(line)))
      return err_set(err, "not enough memory");
    parts->parameters++;
  }
  return 0;
}

int param_record(const Param *p, Parts *parts, Err *err)
{
  Param standard;
  char prefix[64];
  param_defaults(&standard);
  for (int i = 0; i < parts->parameters; i++) free(parts->parameter[i]);
  parts->parameters = 0;
  for (int g = 0; g < GROUPS; g++)
    if (record_rows(parts, groups[g].name, groups[g].rows, groups[g].n, p, &standard, err))
      return -1;
  for (int k = 0; k < p->points; k++) {
    snprintf(prefix, sizeof prefix, POINT_LIST "[%d]", k);
    if (record_rows(parts, prefix, point, POINT_ROWS, &p->point[k], NULL, err)) return -1;
  }
  return 0;
}

/* Text of a table's cell, with something else for each bar. */
static void cell(const char *text, const char *bar, FILE *to)
{
  for (; *text; text++)
    if (*text == '|')
      fputs(bar, to);
    else
      fputc(*text, to);
}

static void print_rows(const char *prefix, const CfgRow *rows, int n, FILE *to)
{
  for (const CfgRow *row = rows; row < rows + n; row++) {
    fprintf(to, "| `%s%s%s` | %s%s%s | ", prefix, *prefix ? "." : "", row->name,
            row->value ? "`" : "", row->value ? row->value : "must be given",
            row->value ? "`" : "");
    cell(row->unit ? row->unit : row->type == CFG_BOOL ? "true|false" : "1", ", ", to);
    fputs(" | ", to);
    cell(row->meaning, "\\|", to);
    fputs(" |\n", to);
  }
}

void param_markdown(FILE *to)
{
  fprintf(to, "| key | default | unit or choice | meaning |\n|---|---|---|---|\n");
  for (int g = 0; g < GROUPS; g++) print_rows(groups[g].name, groups[g].rows, groups[g].n, to);
  print_rows(POINT_LIST, point, POINT_ROWS, to);
}
