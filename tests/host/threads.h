/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs the threads of a grid as fibers on one core: blocks one after another, within a block each
 * fiber until it must wait. In which order is free on a GPU, and so it is here: HOST_CUDA_ORDER is
 * `forward` (default), `reverse`, or a number that seeds a shuffle. A result that differs between
 * them tells of a race. */
#ifndef HOST_THREADS_H
#define HOST_THREADS_H

#include <functional>
#include "cuda_runtime.h"

namespace host
{

/* threads_run: one call of body for each thread of the grid. */
void threads_run(const char *kernel, dim3 blocks, dim3 threads, size_t shared,
                 const std::function<void()> &body);

} // namespace host

#endif
