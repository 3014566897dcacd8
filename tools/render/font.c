/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Glyphs are strokes on a grid: baseline at y = 2, x-height 6, capitals 8, descenders 0. A stroke
 * is a row of points `xy`; after
 * `~` its corners are rounded (quadratic B-spline by Chaikin's cuts), and a stroke that ends where
 * it began is closed. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "font.h"

#define PEN   0.80 /* stroke width in units of the grid */
#define SPACE 1.9  /* between glyphs */
#define RAISE 0.65 /* size of a superscript */
enum { POINTS = 512 };

/* clang-format off */
typedef struct {
  char c;
  int width;
  const char *strokes;
} Glyph;

static const Glyph glyphs[] = {
    {' ', 2, ""}, {'!', 0, "0804 0202"}, {'"', 2, "0807 2827"}, {'#', 4, "1218 3238 0444 0646"},
    {'%', 5, "0258 ~0828260608 ~3454523234"},
    {'&', 4, "~4203182806 ~0604022244"}, {'\'', 0, "0807"}, {'(', 1, "~19070311"}, {')', 1, "~09171301"}, {'*', 3, "0336 0633"},
    {'+', 4, "0545 2327"}, {',', 1, "1201"}, {'-', 3, "0535"}, {'.', 0, "0202"}, {'/', 3, "0138"},
    {'0', 3, "~0838320208"}, {'1', 2, "0728 2822"}, {'2', 3, "~07083835 ~353402 0232"}, {'3', 3, "~0708383515 ~1535320203"},
    {'4', 4, "2804 0444 3532"}, {'5', 3, "3808 0805 ~0536320203"}, {'6', 3, "~3738080203 ~0535320205"}, {'7', 3, "083812"},
    {'8', 3, "~0838350508 ~0535320205"}, {'9', 3, "~0838350508 ~37320203"}, {':', 0, "0303 0606"}, {';', 1, "1606 1201"},
    {'<', 3, "370533"}, {'=', 3, "0434 0636"}, {'>', 3, "073503"}, {'?', 3, "~0708383515 1514 1212"}, {'@', 4, "~4303084835142424"},
    {'A', 4, "022842 1333"}, {'B', 4, "0208 ~08384515 0515 ~15454202 "}, {'C', 4, "~474808024243"}, {'D', 4, "0208 ~08484202"},
    {'E', 3, "38080232 0525"}, {'F', 3, "380802 0525"}, {'G', 4, "~47480802424424"}, {'H', 4, "0208 4248 0545"}, {'I', 0, "0208"},
    {'J', 3, "~38320203"}, {'K', 4, "0208 4804 1542"}, {'L', 3, "080232"}, {'M', 6, "0208356862"}, {'N', 4, "02084248"},
    {'O', 4, "~0848420208"}, {'P', 4, "0208 ~08484505"}, {'Q', 4, "~0848420208 2441"}, {'R', 4, "0208 ~08484505 2542"},
    {'S', 4, "~47480805454202 ~420203"}, {'T', 4, "0848 2822"}, {'U', 4, "~08024248"}, {'V', 4, "082248"}, {'W', 6, "0812365268"},
    {'X', 4, "0248 0842"}, {'Y', 4, "082548 2522"}, {'Z', 4, "08480242"},
    {'[', 1, "18080212"}, {'\\', 3, "0831"}, {']', 1, "08181202"},
    {'_', 4, "0141"}, {'a', 3, "~0636320206 3632"}, {'b', 3, "0802 ~0636320206"}, {'c', 3, "~363506023233"},
    {'d', 3, "3832 ~0636320206"},
    {'e', 3, "0434 ~343606023233"}, {'f', 2, "~281812 0626"}, {'g', 3, "~0636320206 ~36300001"}, {'h', 3, "0802 ~04063632"},
    {'i', 0, "0602 0808"}, {'j', 1, "~161000 1818"}, {'k', 3, "0802 3603 1432"}, {'l', 0, "0802"},
    {'m', 6, "0602 ~04063632 ~34366662"},
    {'n', 3, "0602 ~04063632"}, {'o', 3, "~0636320206"}, {'p', 3, "0600 ~0636320206"}, {'q', 3, "3630 ~0636320206"},
    {'r', 2, "0602 ~040626"},
    {'s', 3, "~3606043432 ~343202"}, {'t', 2, "~181222 0626"}, {'u', 3, "~06023234 3632"}, {'v', 4, "062246"}, {'w', 4, "0612243246"},
    {'x', 3, "0236 0632"}, {'y', 3, "~06023234 ~36300001"}, {'z', 3, "06360232"},
    {'{', 1, "~18080212"}, {'|', 0, "0109"}, {'}', 1, "~08181202"}};
static const Glyph unknown = {0, 3, "0838320208"};
/* clang-format on */

static const Glyph *glyph(char c)
{
  for (size_t k = 0; k < sizeof glyphs / sizeof *glyphs; k++)
    if (glyphs[k].c == c) return &glyphs[k];
  return &unknown;
}

typedef struct {
  double x, y;
} Point;

/* One round of corner cutting: ends stay, or the last point is the first of a closed stroke. */
static int cut_corners(Point *p, int n)
{
  Point q[POINTS];
  int m = 0, closed = p[0].x == p[n - 1].x && p[0].y == p[n - 1].y;
  if (2 * n > POINTS) return n;
  if (!closed) q[m++] = p[0];
  for (int k = 0; k + 1 < n; k++) {
    Point a = p[k], b = p[k + 1];
    q[m++] = (Point){0.75 * a.x + 0.25 * b.x, 0.75 * a.y + 0.25 * b.y};
    q[m++] = (Point){0.25 * a.x + 0.75 * b.x, 0.25 * a.y + 0.75 * b.y};
  }
  q[m++] = closed ? q[0] : p[n - 1];
  memcpy(p, q, (size_t)m * sizeof *q);
  return m;
}

/* The points of the next stroke; *s moves behind it. 0: no more. */
static int stroke(const char **s, Point *p)
{
  int n = 0, round = 0;
  while (**s == ' ') ++*s;
  if (**s == '~') round = 1, ++*s;
  for (; **s && **s != ' '; *s += 2) p[n++] = (Point){(*s)[0] - '0', (*s)[1] - '2'};
  for (int k = 0; k < 4 && round && n > 2; k++) n = cut_corners(p, n);
  return n;
}

static double distance(double x, double y, Point a, Point b)
{
  double dx = b.x - a.x, dy = b.y - a.y, l2 = dx * dx + dy * dy;
  double t = l2 > 0 ? ((x - a.x) * dx + (y - a.y) * dy) / l2 : 0;
  t = fmin(1, fmax(0, t));
  return hypot(x - a.x - t * dx, y - a.y - t * dy);
}

/* Coverage of a run of text, px; kept apart so that strokes which overlap are not blended twice. */
typedef struct {
  int x0, y0, w, h;
  float *ink, *halo;
  double pen, rim; /* half widths */
} Ink;

static void segment(Ink *k, Point a, Point b)
{
  double reach = k->pen + k->rim + 1;
  int i0 = (int)floor(fmin(a.x, b.x) - reach), i1 = (int)ceil(fmax(a.x, b.x) + reach);
  int j0 = (int)floor(fmin(a.y, b.y) - reach), j1 = (int)ceil(fmax(a.y, b.y) + reach);
  for (int j = j0; j <= j1; j++)
    for (int i = i0; i <= i1; i++) {
      int u = i - k->x0, v = j - k->y0;
      if (u < 0 || v < 0 || u >= k->w || v >= k->h) continue;
      double d = distance(i + 0.5, j + 0.5, a, b);
      float ink = (float)fmin(1, fmax(0, k->pen + 0.5 - d)),
            halo = (float)fmin(1, fmax(0, k->pen + k->rim + 0.5 - d));
      float *p = k->ink + (long)v * k->w + u, *q = k->halo + (long)v * k->w + u;
      *p = fmaxf(*p, ink), *q = fmaxf(*q, halo);
    }
}

/* Advances over the text, in grid units; calls segment when k is given. */
static double run(const char *text, double unit, const Font *f, double x, double y, Ink *k)
{
  double at = PEN / 2;
  Point p[POINTS];
  for (int up = 0; *text; text++) {
    if (*text == '^') {
      up = 1;
      continue;
    }
    if (up == 1 && *text != '-' && (*text < '0' || *text > '9')) up = 0;
    double size = up ? RAISE : 1, lift = up ? 3.4 : 0;
    const Glyph *g = glyph(*text);
    const char *s = g->strokes;
    for (int n; k && (n = stroke(&s, p));) {
      for (int i = 0; i < n; i++) {
        double a = unit * (at + size * p[i].x), b = unit * (lift + size * p[i].y);
        p[i] = f->up ? (Point){x - b, y - a} : (Point){x + a, y - b};
      }
      for (int i = 0; i + 1 < n; i++) segment(k, p[i], p[i + 1]);
    }
    at += size * (g->width + SPACE);
  }
  return unit * (at > PEN ? at - SPACE + PEN / 2 : 0);
}

double font_width(const char *text, double size) { return run(text, size / 6, NULL, 0, 0, NULL); }

void font_draw(Image *im, const Font *f, double x, double y, const char *text)
{
  double width = font_width(text, f->size), back = f->align == FONT_RIGHT    ? width
                                                   : f->align == FONT_CENTRE ? width / 2
                                                                             : 0;
  Ink k = {.pen = fmax(0.55, PEN * f->size / 12), .rim = fmax(1, f->size / 9)};
  int across = (int)ceil(width + f->size) + 8, tall = (int)ceil(2.2 * f->size) + 8;
  if (f->up)
    y += back;
  else
    x -= back;
  k.w = f->up ? tall : across, k.h = f->up ? across : tall;
  k.x0 = (int)floor(f->up ? x - 1.5 * f->size : x - f->size / 2) - 4;
  k.y0 = (int)floor(f->up ? y - width - f->size / 2 : y - 1.5 * f->size) - 4;
  k.ink = calloc((size_t)k.w * (size_t)k.h * 2, sizeof *k.ink);
  if (!k.ink) err_die("out of memory");
  k.halo = k.ink + (long)k.w * k.h;
  run(text, f->size / 6, f, x, y, &k);
  for (int v = 0; v < k.h; v++)
    for (int u = 0; u < k.w; u++) {
      image_blend(im, k.x0 + u, k.y0 + v, f->halo, 0.6 * k.halo[(long)v * k.w + u]);
      image_blend(im, k.x0 + u, k.y0 + v, f->ink, k.ink[(long)v * k.w + u]);
    }
  free(k.ink);
}
