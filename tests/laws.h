/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Materials in units of their own, every law among them; two of them with tables in files. */
#ifndef LAWS_H
#define LAWS_H

#define LIQUID(NAME)                                                                               \
  "name = \"" NAME "\"; eos = { form = \"liquid\"; rho0 = 1.; c = 1.; heat_capacity = 1.; };"
static const char *const materials[] = {
    "name = \"a\"; eos = { form = \"murnaghan\"; rho0 = 1.; K = 1.; n = 2.; };"
    "strength = { shear_modulus = 1.; form = \"von_mises\"; Y = 0.1; melt_energy = 1.5; };"
    "damage = { form = \"grady_kipp\"; k = 1e10; m = 5.; };",
    "name = \"b\"; eos = { form = \"tillotson\"; rho0 = 1.; A = 1.; B = 1.; E0 = 1.; Eiv = 0.3;"
    "Ecv = 1.; a = 0.5; b = 1.5; alpha = 5.; beta = 5.; };"
    "strength = { shear_modulus = 0.5; form = \"benz_asphaug\"; Y = 0.1; melt_energy = 1.; };"
    "damage = { form = \"grady_kipp\"; k = 1e11; m = 6.; };",
    "name = \"c\"; eos = { form = \"liquid\"; rho0 = 1.; c = 1.; };",
    "name = \"d\"; eos = { form = \"stiffened\"; rho0 = 1.; c = 1.; G = 0.3; };",
    "name = \"e\"; eos = { form = \"ideal\"; gamma = 1.4; c_min = 0.1; };",
    "name = \"f\"; eos = { form = \"polytropic\"; K = 1.; gamma = 1.6; };",
    "name = \"g\"; eos = { form = \"isothermal\"; c = 1.; };",
    "name = \"h\"; eos = { form = \"local_isothermal\"; aspect = 0.1; mass = 1e10; r_min = 0.1; "
    "};",
    LIQUID("i") "strength = { shear_modulus = 1.; form = \"drucker_prager\"; cohesion = 0.1;"
                "friction = 0.5; weak_limit = 0.9; weak_gamma = 0.5; };",
    LIQUID("j") "strength = { shear_modulus = 1.; form = \"mohr_coulomb\"; cohesion = 0.1;"
                "friction = 0.5; };",
    LIQUID("k") "strength = { shear_modulus = 1.; form = \"lundborg\"; cohesion = 0.1;"
                "friction = 1.; limit = 0.3; };",
    LIQUID(
        "l") "strength = { shear_modulus = 1.; form = \"collins\"; cohesion = 0.1; friction = 1.;"
             "limit = 0.3; friction_damaged = 0.5; melt_energy = 2.; };",
    LIQUID("m") "strength = { shear_modulus = 1.; form = \"johnson_cook\"; A = 0.1; B = 0.1;"
                "n = 0.3; C = 0.1; rate0 = 0.1; T0 = 0.; Tmelt = 2.; };",
    "name = \"n\"; eos = { form = \"table\"; file = \"heat.h5\"; rho0 = 1.; };"
    "strength = { shear_modulus = 1.; form = \"none\"; };",
    "name = \"o\"; eos = { form = \"table\"; file = \"energy.h5\"; };",
    LIQUID("p") "strength = { shear_modulus = 1.; form = \"lundborg\"; cohesion = 0.1; friction = "
                "1.; };"
                "damage = { form = \"grady_kipp\"; k = 1e10; m = 5.; };"
                "porosity = { form = \"p_alpha\"; alpha_0 = 1.5; c_elastic = 0.5; p_e = 0.01; p_s "
                "= 1.; };",
    LIQUID("q") "porosity = { form = \"p_alpha_two_power\"; alpha_0 = 1.5; p_e = 0.01; p_t = 0.1;"
                "p_s = 1.; alpha_e = 2.; alpha_t = 1.3; n1 = 3.; n2 = 2.; };",
    LIQUID("r") "porosity = { form = \"p_alpha_blum\"; alpha_0 = 1.8; p_0 = 0.04; };",
    LIQUID("s") "porosity = { form = \"p_alpha_log\"; alpha_0 = 1.5; a = 0.7; };",
    LIQUID("t") "porosity = { form = \"p_alpha_power\"; alpha_0 = 1.5; a = 0.9; b = 0.01; };",
    LIQUID(
        "u") "strength = { shear_modulus = 1.; form = \"none\"; };"
             "porosity = { form = \"epsilon_alpha\"; alpha_0 = 1.5; kappa = 0.9; epsilon_x = -0.2;"
             "gamma = 0.5; };",
    LIQUID("v") "strength = { shear_modulus = 1.; form = \"porous\"; };"
                "porosity = { form = \"sirono\"; alpha_0 = 3.; K_0 = 1.; p_m = 0.1; a = -2.; };",
    LIQUID(
        "w") "strength = { shear_modulus = 1.; form = \"regolith\"; cohesion = 0.1; friction = 0.5;"
             "dilatancy = 0.3; };",
    LIQUID("x") "strength = { shear_modulus = 1.; form = \"viscous_regolith\"; cohesion = 0.1;"
                "friction = 0.5; viscosity = 0.1; };",
    "name = \"y\"; eos = { form = \"tillotson\"; rho0 = 1.; A = 1.; B = 1.; E0 = 1.; Eiv = 0.3;"
    "Ecv = 1.; a = 0.5; b = 1.5; alpha = 5.; beta = 5.; };"
    "strength = { shear_modulus = 1.; form = \"collins\"; cohesion = 0.1; friction = 1.;"
    "limit = 0.3; cohesion_damaged = 0.05; friction_damaged = 0.5; weak_limit = 0.8; weak_gamma = "
    "0.5; };"
    "damage = { form = \"grady_kipp\"; k = 1e10; m = 5.; shear = 0.; };"
    "porosity = { form = \"p_alpha\"; alpha_0 = 1.5; p_e = 0.01; p_s = 1.; };",
    "name = \"z\"; eos = { form = \"table\"; file = \"energy.h5\"; rho0 = 1.; };"
    "strength = { shear_modulus = 1.; form = \"von_mises\"; Y = 0.1; };"
    "porosity = { form = \"epsilon_alpha\"; alpha_0 = 1.3; kappa = 0.9; epsilon_x = -0.2; };"};
enum { MATERIALS = sizeof materials / sizeof *materials };

#endif
