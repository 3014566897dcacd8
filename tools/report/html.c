/* SPDX-License-Identifier: GPL-3.0-or-later */
/* HTML 5; files become data: URLs (RFC 2397, base64 of RFC 4648). */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "html.h"
#include "lib/spool.h"
#include "lib/tsv.h"

/* clang-format off */
static const char style[] =
  ":root{--ink:#1d2129;--soft:#5c6370;--line:#dfe2e8;--paper:#fff;--panel:#f6f7f9;--accent:#0a5c9c}\n"
  "@media(prefers-color-scheme:dark){:root{--ink:#e4e6eb;--soft:#9aa1ad;--line:#32363f;--paper:#14161a;"
  "--panel:#1d2026;--accent:#7ab8ee}}\n"
  "*{box-sizing:border-box}\n"
  "body{margin:0;background:var(--paper);color:var(--ink);"
  "font:16px/1.55 system-ui,-apple-system,'Segoe UI',Roboto,'DejaVu Sans',sans-serif}\n"
  "main{max-width:1080px;margin:0 auto;padding:1.5rem 1.25rem 4rem}\n"
  "h1{font-size:1.75rem;line-height:1.25;margin:.5rem 0 .25rem;overflow-wrap:anywhere}\n"
  "h2{font-size:1.2rem;margin:2.6rem 0 .8rem;padding-bottom:.35rem;border-bottom:1px solid var(--line)}\n"
  ".sub,figcaption,.note{color:var(--soft)}.sub{margin:0 0 1rem;overflow-wrap:anywhere}\n"
  "nav{display:flex;flex-wrap:wrap;gap:.3rem 1.1rem;margin:1rem 0 0}a{color:var(--accent);text-decoration:none}"
  "a:hover{text-decoration:underline}\n"
  "figure{margin:0 0 1.6rem}figure img,figure video{display:block;width:100%;height:auto;border-radius:6px;"
  "border:1px solid var(--line)}\n"
  "figure.small{display:inline-block;width:calc(50% - 1.1rem);margin-right:.8rem;vertical-align:top}\n"
  "figcaption,.note{font-size:.9rem;margin:.5rem 0;overflow-wrap:anywhere}\n"
  ".wide{overflow-x:auto;border:1px solid var(--line);border-radius:6px;margin:.4rem 0 1rem}\n"
  "table{border-collapse:collapse;width:100%;font-size:.88rem;font-variant-numeric:tabular-nums}\n"
  "th,td{padding:.38rem .7rem;text-align:right;white-space:nowrap;border-bottom:1px solid var(--line)}\n"
  "th{background:var(--panel);font-weight:600;vertical-align:bottom}th small{display:block;font-weight:400;color:var(--soft)}\n"
  "td:first-child,th:first-child{text-align:left}tr:last-child td{border-bottom:0}\n"
  "td.word{text-align:left}\n"
  "dl{display:grid;grid-template-columns:max-content 1fr;gap:.3rem 1.4rem;margin:0 0 1rem}dt{color:var(--soft)}"
  "dd{margin:0;overflow-wrap:anywhere}\n"
  "pre{background:var(--panel);border:1px solid var(--line);border-radius:6px;padding:.8rem 1rem;overflow-x:auto;"
  "font:.82rem/1.5 ui-monospace,'DejaVu Sans Mono',monospace;margin:.4rem 0 1rem}\n"
  "ol.history{padding-left:1.6rem}ol.history code{overflow-wrap:anywhere}ol.history small{color:var(--soft)}\n"
  "code{font:.86em ui-monospace,'DejaVu Sans Mono',monospace}\n"
  "details{margin:.4rem 0}summary{cursor:pointer;color:var(--accent);padding:.25rem 0}\n"
  "footer{margin-top:3rem;padding-top:.8rem;border-top:1px solid var(--line);color:var(--soft);font-size:.85rem}\n"
  "@media(max-width:600px){figure.small{width:100%;margin-right:0}}\n"
  "@media(max-width:600px){main{padding:1rem .9rem 3rem}h1{font-size:1.4rem}dl{grid-template-columns:1fr;gap:0}"
  "dd{margin-bottom:.6rem}}\n"
  "@media print{details{display:none}}\n";
/* clang-format on */

void html_text(FILE *f, const char *text)
{
  for (; *text; text++) switch (*text) {
    case '<': fputs("&lt;", f); break;
    case '>': fputs("&gt;", f); break;
    case '&': fputs("&amp;", f); break;
    case '"': fputs("&quot;", f); break;
    default: fputc(*text, f);
    }
}

/* Between two tags. */
static void element(FILE *f, const char *before, const char *text, const char *after)
{
  fputs(before, f), html_text(f, text), fputs(after, f);
}

void html_begin(FILE *f, const char *title, const char *subtitle)
{
  fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n",
        f);
  element(f, "<title>", title, "</title>\n");
  fprintf(f, "<style>\n%s</style>\n</head>\n<body>\n<main>\n", style);
  element(f, "<h1>", title, "</h1>\n");
  if (*subtitle) element(f, "<p class=\"sub\">", subtitle, "</p>\n");
}

void html_end(FILE *f, const char *foot)
{
  element(f, "<footer>", foot, "</footer>\n</main>\n</body>\n</html>\n");
}

void html_section(FILE *f, const char *id, const char *title)
{
  fprintf(f, "<h2 id=\"%s\">", id);
  element(f, "", title, "</h2>\n");
}

void html_pre(FILE *f, const char *text, const char *fold)
{
  if (fold) element(f, "<details><summary>", fold, "</summary>\n");
  element(f, "<pre>", text, "</pre>\n");
  if (fold) fputs("</details>\n", f);
}

void html_pairs(FILE *f, int open) { fputs(open ? "<dl>\n" : "</dl>\n", f); }

void html_pair(FILE *f, const char *name, const char *value)
{
  element(f, "<dt>", name, "</dt>");
  element(f, "<dd>", value, "</dd>\n");
}

/* ---- pictures ---- */

static void base64(FILE *f, const unsigned char *b, size_t n)
{
  static const char digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (size_t k = 0; k < n; k += 3) {
    unsigned long three = (unsigned long)b[k] << 16 | (k + 1 < n ? b[k + 1] : 0ul) << 8 |
                          (k + 2 < n ? b[k + 2] : 0ul);
    fputc(digit[three >> 18], f), fputc(digit[three >> 12 & 63], f);
    fputc(k + 1 < n ? digit[three >> 6 & 63] : '=', f),
        fputc(k + 2 < n ? digit[three & 63] : '=', f);
  }
}

static unsigned char *contents(const char *path, size_t *n, Err *err)
{
  FILE *f = fopen(path, "rb");
  unsigned char *data = NULL;
  long size = -1;
  if (f && !fseek(f, 0, SEEK_END)) size = ftell(f);
  if (size >= 0 && !fseek(f, 0, SEEK_SET)) data = malloc((size_t)size + 1);
  if (data && fread(data, 1, (size_t)size, f) != (size_t)size) free(data), data = NULL;
  if (!data) err_set(err, "cannot read '%s': %s", path, strerror(errno));
  if (f) fclose(f);
  *n = data ? (size_t)size : 0;
  return data;
}

/* By the first bytes. */
static const char *media(const unsigned char *b, size_t n)
{
  if (n > 8 && !memcmp(b, "\x89PNG", 4)) return "image/png";
  if (n > 8 && !memcmp(b, "GIF8", 4)) return "image/gif";
  if (n > 8 && !memcmp(b, "\xff\xd8\xff", 3)) return "image/jpeg";
  if (n > 12 && !memcmp(b + 4, "ftyp", 4)) return "video/mp4";
  if (n > 8 && !memcmp(b, "\x1a\x45\xdf\xa3", 4)) return "video/webm";
  if (n > 8 && (!memcmp(b, "<svg", 4) || !memcmp(b, "<?xml", 5))) return "image/svg+xml";
  return NULL;
}

/* Whether two go side by side: PNGs of up to 700 px. */
static int is_small(const unsigned char *b, const char *type, size_t n)
{
  return !strcmp(type, "image/png") && n > 20 && b[16] == 0 && b[17] == 0 &&
         b[18] * 256 + b[19] <= 700;
}

int html_picture(FILE *f, const char *path, const char *caption, Err *err)
{
  size_t n;
  unsigned char *data = contents(path, &n, err);
  const char *type = data ? media(data, n) : NULL;
  if (data && !type) err_set(err, "'%s' is no PNG, JPEG, GIF, SVG, MP4 or WebM", path);
  if (type) {
    int film = !strncmp(type, "video", 5);
    fprintf(f, "<figure%s><%s src=\"data:%s;base64,",
            is_small(data, type, n) ? " class=\"small\"" : "",
            film ? "video controls loop muted" : "img", type);
    base64(f, data, n);
    element(f, film ? "\" title=\"" : "\" alt=\"", caption, film ? "\"></video>" : "\">");
    element(f, "<figcaption>", caption, "</figcaption></figure>\n");
  }
  free(data);
  return type ? 0 : -1;
}

/* ---- tables ---- */

/* Four digits; powers of ten as such. Words stay, and counts, which have no unit. */
static void cell(FILE *f, const char *text, int counts)
{
  char *end, number[64];
  double x = strtod(text, &end);
  if (end == text || *end || !isfinite(x)) {
    element(f, end == text || *end ? "<td class=\"word\">" : "<td>", text, "</td>");
    return;
  }
  snprintf(number, sizeof number, x == rint(x) && fabs(x) < (counts ? 1e15 : 1e4) ? "%.0f" : "%.4g",
           x);
  char *e = strchr(number, 'e');
  if (e) *e = 0;
  fprintf(f, "<td>%s", number);
  if (e) fprintf(f, " &times; 10<sup>%d</sup>", atoi(e + 1));
  fputs("</td>", f);
}

static void rows_of(FILE *f, const Tsv *t, long rows, int columns)
{
  fputs("<div class=\"wide\"><table>\n<thead><tr>", f);
  for (int c = 0; c < columns; c++) {
    element(f, "<th>", t->name[c], "");
    if (*t->unit[c] && strcmp(t->unit[c], "1")) element(f, "<small>", t->unit[c], "</small>");
    fputs("</th>", f);
  }
  fputs("</tr></thead>\n<tbody>\n", f);
  for (long r = 0; r < rows && r < t->rows; r++) {
    fputs("<tr>", f);
    for (int c = 0; c < columns; c++) cell(f, t->cell[r * t->columns + c], !*t->unit[c]);
    fputs("</tr>\n", f);
  }
  fputs("</tbody></table></div>\n", f);
}

/* The comments of a table but the last, which names the columns. */
static void comments(FILE *f, const char *path)
{
  char line[2048], last[2048] = "";
  FILE *in = fopen(path, "r");
  int any = 0;
  while (in && fgets(line, sizeof line, in) && *line == '#') {
    line[strcspn(line, "\n")] = 0;
    if (*last) element(f, any++ ? "<br>\n" : "<p class=\"note\">", last + strspn(last, "# "), "");
    memcpy(last, line, sizeof last);
  }
  if (any) fputs("</p>\n", f);
  if (in) fclose(in);
}

int html_table(FILE *f, const char *path, const char *caption, long rows, int columns, Err *err)
{
  Tsv t;
  char more[128];
  if (tsv_read(&t, path, err)) return -1;
  element(f, "<h3>", caption, "</h3>\n");
  comments(f, path);
  rows_of(f, &t, rows, columns < t.columns ? columns : t.columns);
  if (t.rows > rows) fprintf(f, "<p class=\"note\">%ld of %ld rows.</p>\n", rows, t.rows);
  if (t.columns > columns) {
    snprintf(more, sizeof more, "all %d columns", t.columns);
    element(f, "<details><summary>", more, "</summary>\n");
    rows_of(f, &t, rows, t.columns);
    fputs("</details>\n", f);
  }
  tsv_free(&t);
  return 0;
}
