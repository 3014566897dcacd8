/* SPDX-License-Identifier: GPL-3.0-or-later */
/* CUDA's small vectors: names, members and alignment as in the toolkit's vector_types.h. */
#ifndef HOST_VECTOR_H
#define HOST_VECTOR_H

#define HOST_ALIGN(BYTES) alignas((BYTES) < 16 ? (BYTES) : 16)
#define HOST_VECTOR(T, NAME)                                                                       \
  struct NAME##1 { T x; };                                                                         \
  struct HOST_ALIGN(2 * sizeof(T)) NAME##2 { T x, y; };                                            \
  struct NAME##3 { T x, y, z; };                                                                   \
  struct HOST_ALIGN(4 * sizeof(T)) NAME##4 { T x, y, z, w; };                                      \
  static inline NAME##1 make_##NAME##1(T x) { return {x}; }                                        \
  static inline NAME##2 make_##NAME##2(T x, T y) { return {x, y}; }                                \
  static inline NAME##3 make_##NAME##3(T x, T y, T z) { return {x, y, z}; }                        \
  static inline NAME##4 make_##NAME##4(T x, T y, T z, T w) { return {x, y, z, w}; }

HOST_VECTOR(signed char, char)
HOST_VECTOR(unsigned char, uchar)
HOST_VECTOR(short, short)
HOST_VECTOR(unsigned short, ushort)
HOST_VECTOR(int, int)
HOST_VECTOR(unsigned, uint)
HOST_VECTOR(long long, longlong)
HOST_VECTOR(unsigned long long, ulonglong)
HOST_VECTOR(float, float)
HOST_VECTOR(double, double)
#undef HOST_VECTOR
#undef HOST_ALIGN

struct dim3 {
  unsigned x, y, z;
  constexpr dim3(unsigned a = 1, unsigned b = 1, unsigned c = 1) : x(a), y(b), z(c) {}
  constexpr dim3(uint3 v) : x(v.x), y(v.y), z(v.z) {}
  constexpr operator uint3() const { return {x, y, z}; }
};

#endif
