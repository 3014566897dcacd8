/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pixels, and PNG by libpng. */
#include <errno.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <png.h>
#include "image.h"
#include "lib/spool.h"

Image *image_new(int w, int h, Rgb fill)
{
  Image *im = malloc(sizeof *im);
  if (im) *im = (Image){w, h, malloc((size_t)w * (size_t)h * sizeof *im->px)};
  if (im && !im->px) {
    free(im);
    return NULL;
  }
  for (long i = 0; im && i < (long)w * h; i++) im->px[i] = fill;
  return im;
}

void image_free(Image *im)
{
  if (im) free(im->px);
  free(im);
}

static unsigned char mix(unsigned char a, unsigned char b, double weight)
{
  return (unsigned char)(a + (b - a) * weight + 0.5);
}

void image_blend(Image *im, int x, int y, Rgb c, double weight)
{
  if (x < 0 || y < 0 || x >= im->w || y >= im->h || weight <= 0) return;
  if (weight > 1) weight = 1;
  Rgb *p = &im->px[(long)y * im->w + x];
  *p = (Rgb){mix(p->r, c.r, weight), mix(p->g, c.g, weight), mix(p->b, c.b, weight)};
}

void image_fill(Image *im, int x, int y, int w, int h, Rgb c)
{
  for (int j = y; j < y + h; j++)
    for (int i = x; i < x + w; i++) image_blend(im, i, j, c, 1);
}

/* libpng reports through these; the reason is kept, the jump goes back to write_png. */
static void failed(png_structp png, png_const_charp text)
{
  err_set(png_get_error_ptr(png), "%s", errno ? strerror(errno) : text);
  png_longjmp(png, 1);
}

static void warned(png_structp png, png_const_charp text) { (void)png, (void)text; }

static int write_png(const Image *im, FILE *f, Err *err)
{
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, err, failed, warned);
  png_infop info = png ? png_create_info_struct(png) : NULL;
  if (!info) {
    png_destroy_write_struct(&png, NULL);
    return err_set(err, "out of memory");
  }
  if (setjmp(png_jmpbuf(png))) {
    png_destroy_write_struct(&png, &info);
    return -1;
  }
  errno = 0;
  png_init_io(png, f);
  png_set_IHDR(png, info, (png_uint_32)im->w, (png_uint_32)im->h, 8, PNG_COLOR_TYPE_RGB,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(png, 6);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(png, info);
  for (int y = 0; y < im->h; y++) png_write_row(png, (png_const_bytep)(im->px + (long)y * im->w));
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return 0;
}

int image_write(const Image *im, const char *path, Err *err)
{
  Spool s;
  Err why = {""};
  const char *name = path ? path : "-";
  if (spool_out(&s, path, 1, err)) return -1;
  FILE *f = fopen(s.path, "wb");
  if (!f) err_set(&why, "%s", strerror(errno));
  int bad = !f || write_png(im, f, &why);
  if (!bad && (fflush(f) || ferror(f))) bad = 1, err_set(&why, "%s", strerror(errno));
  if (f && fclose(f) && !bad) bad = 1, err_set(&why, "%s", strerror(errno));
  if (!bad) return spool_commit(&s, err);
  spool_abort(&s);
  return err_set(err, "cannot write '%s': %s", name, why.text);
}
