/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Uniform maps as polynomials of degree 6 in each of r, g, b: fits by M. Zucker (2019,
 * shadertoy.com/view/WlfXRN, CC0), within 2 % of the tables of matplotlib. The polar map
 * interpolates ColorBrewer's RdBu (C. Brewer, Apache 2.0). */
#include <string.h>
#include "colour.h"

/* clang-format off */
static const double viridis[7][3] = {
    {0.2777273272234177, 0.005407344544966578, 0.3340998053353061}, {0.1050930431085774, 1.404613529898575, 1.384590162594685},
    {-0.3308618287255563, 0.214847559468213, 0.09509516302823659}, {-4.634230498983486, -5.799100973351585, -19.33244095627987},
    {6.228269936347081, 14.17993336680509, 56.69055260068105}, {4.776384997670288, -13.74514537774601, -65.35303263337234},
    {-5.435455855934631, 4.645852612178535, 26.3124352495832}};
static const double magma[7][3] = {
    {-0.002136485053939582, -0.000749655052795221, -0.005386127855323933}, {0.2516605407371642, 0.6775232436837668, 2.494026599312351},
    {8.353717279216625, -3.577719514958484, 0.3144679030132573}, {-27.66873308576866, 14.26473078096533, -13.64921318813922},
    {52.17613981234068, -27.94360607168351, 12.94416944238394}, {-50.76852536473588, 29.04658282127291, 4.23415299384598},
    {18.65570506591883, -11.48977351997711, -5.601961508734096}};
static const double inferno[7][3] = {
    {0.0002189403691192265, 0.001651004631001012, -0.01948089843709184}, {0.1065134194856116, 0.5639564367884091, 3.932712388889277},
    {11.60249308247187, -3.972853965665698, -15.9423941062914}, {-41.70399613139459, 17.43639888205313, 44.35414519872813},
    {77.162935699427, -33.40235894210092, -81.80730925738993}, {-71.31942824499214, 32.62606426397723, 73.20951985803202},
    {25.13112622477341, -12.24266895238567, -23.07032500287172}};
static const Rgb polar[11] = {{5, 48, 97}, {33, 102, 172}, {67, 147, 195}, {146, 197, 222}, {209, 229, 240}, {247, 247, 247},
    {253, 219, 199}, {244, 165, 130}, {214, 96, 77}, {178, 24, 43}, {103, 0, 31}};

/* Okabe & Ito (2008), distinct for the colour blind. */
static const Rgb okabe_ito[] = {{230, 159, 0}, {86, 180, 233}, {0, 158, 115}, {240, 228, 66}, {0, 114, 178}, {213, 94, 0}, {204, 121, 167}};

static const struct {
  const char *word;
  Rgb colour;
} materials[] = {{"ice", {92, 158, 235}}, {"water", {58, 104, 214}}, {"h2o", {58, 104, 214}}, {"basalt", {196, 62, 52}},
    {"granite", {214, 132, 108}}, {"iron", {150, 152, 160}}, {"olivine", {122, 158, 62}}, {"dunite", {104, 142, 78}},
    {"aluminium", {190, 198, 208}}, {"nylon", {224, 206, 150}}, {"lucite", {150, 210, 200}}, {"polycarbonate", {206, 186, 226}}};
/* clang-format on */

static unsigned char byte(double x)
{
  return (unsigned char)(x <= 0 ? 0 : x >= 1 ? 255 : 255 * x + 0.5);
}

static Rgb polynomial(const double c[7][3], double t)
{
  double v[3];
  for (int a = 0; a < 3; a++) {
    v[a] = c[6][a];
    for (int k = 5; k >= 0; k--) v[a] = v[a] * t + c[k][a];
  }
  return (Rgb){byte(v[0]), byte(v[1]), byte(v[2])};
}

static Rgb between(double t)
{
  double at = 10 * t;
  int k = at >= 10 ? 9 : (int)at;
  double f = at - k;
  Rgb a = polar[k], b = polar[k + 1];
  return (Rgb){byte((a.r + f * (b.r - a.r)) / 255), byte((a.g + f * (b.g - a.g)) / 255),
               byte((a.b + f * (b.b - a.b)) / 255)};
}

Rgb colour_map(const char *map, double t)
{
  t = t > 0 ? (t < 1 ? t : 1) : 0;
  if (!strcmp(map, "polar")) return between(t);
  return polynomial(!strcmp(map, "magma") ? magma : !strcmp(map, "inferno") ? inferno : viridis, t);
}

Rgb colour_kind(long k)
{
  long n = (long)(sizeof okabe_ito / sizeof *okabe_ito);
  return colour_shade(okabe_ito[k % n], k < n ? 1 : 0.6);
}

Rgb colour_of_material(const char *name, int k)
{
  for (size_t i = 0; i < sizeof materials / sizeof *materials; i++)
    if (strstr(name, materials[i].word)) return materials[i].colour;
  return colour_kind(k);
}

Rgb colour_shade(Rgb c, double f)
{
  return (Rgb){byte(c.r * f / 255), byte(c.g * f / 255), byte(c.b * f / 255)};
}
