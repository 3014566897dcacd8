/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stands in for the CUDA backend in builds without nvcc: it is not there. */
#include "../backend.h"

static int nocuda_cards(void) { return -1; }

const struct backend backend_cuda = {.name = "cuda", .cards = nocuda_cards};
