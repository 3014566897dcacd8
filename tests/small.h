/* SPDX-License-Identifier: GPL-3.0-or-later */
/* For tests of CUDA code, which tests/sanitize runs under tools that make a launch many times
 * slower: BRECCIA_TEST_SMALL asks for the fewest cases that still reach every branch,
 * BRECCIA_TEST_ONLY for the one test of that name. Include it after cmocka. */
#ifndef SMALL_H
#define SMALL_H

#include <stdlib.h>

/* small_or: usual, or least when few cases are asked for. */
static inline long small_or(long usual, long least)
{
  return getenv("BRECCIA_TEST_SMALL") ? least : usual;
}

__attribute__((constructor)) static void small_only(void)
{
  const char *name = getenv("BRECCIA_TEST_ONLY");
  if (name) cmocka_set_test_filter(name);
}

#endif
