// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// D registers as columns of a table with D numbers a row, and back:
//   interleave   out[D e + c] = in[c][e]
//   row_sums     out[e] = sum_c in[D e + c]
// e runs over the lanes; out and in hold D registers one after the other.
#pragma once

namespace shoal::solid {

// Particles of a lattice that are looked at together: as many as a register holds numbers.
#ifdef __AVX512F__
inline constexpr int group = 8;
#else
inline constexpr int group = 4;
#endif
typedef double VG __attribute__((vector_size(8 * group)));

#ifdef __AVX512F__

inline void interleave(const VG (&in)[2], VG (&out)[2]) {
  out[0] = __builtin_shufflevector(in[0], in[1], 0, 8, 1, 9, 2, 10, 3, 11);
  out[1] = __builtin_shufflevector(in[0], in[1], 4, 12, 5, 13, 6, 14, 7, 15);
}
inline void interleave(const VG (&in)[3], VG (&out)[3]) {
  const VG a = __builtin_shufflevector(in[0], in[1], 0, 8, 0, 1, 9, 0, 2, 10);
  const VG b = __builtin_shufflevector(in[0], in[1], 0, 3, 11, 0, 4, 12, 0, 5);
  const VG c = __builtin_shufflevector(in[0], in[1], 13, 0, 6, 14, 0, 7, 15, 0);
  out[0] = __builtin_shufflevector(a, in[2], 0, 1, 8, 3, 4, 9, 6, 7);
  out[1] = __builtin_shufflevector(b, in[2], 10, 1, 2, 11, 4, 5, 12, 7);
  out[2] = __builtin_shufflevector(c, in[2], 0, 13, 2, 3, 14, 5, 6, 15);
}
inline VG row_sums(const VG& a, const VG& b) {
  return __builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14) +
         __builtin_shufflevector(a, b, 1, 3, 5, 7, 9, 11, 13, 15);
}
inline VG row_sums(const VG& a, const VG& b, const VG& c) {
  const VG first = __builtin_shufflevector(a, b, 0, 3, 6, 9, 12, 15, 0, 0);
  const VG second = __builtin_shufflevector(a, b, 1, 4, 7, 10, 13, 0, 0, 0);
  const VG third = __builtin_shufflevector(a, b, 2, 5, 8, 11, 14, 0, 0, 0);
  return __builtin_shufflevector(first, c, 0, 1, 2, 3, 4, 5, 10, 13) +
         __builtin_shufflevector(second, c, 0, 1, 2, 3, 4, 8, 11, 14) +
         __builtin_shufflevector(third, c, 0, 1, 2, 3, 4, 9, 12, 15);
}

#else

inline void interleave(const VG (&in)[2], VG (&out)[2]) {
  out[0] = __builtin_shufflevector(in[0], in[1], 0, 4, 1, 5);
  out[1] = __builtin_shufflevector(in[0], in[1], 2, 6, 3, 7);
}
inline void interleave(const VG (&in)[3], VG (&out)[3]) {
  const VG a = __builtin_shufflevector(in[0], in[1], 0, 4, 0, 1);
  const VG b = __builtin_shufflevector(in[0], in[1], 5, 0, 2, 6);
  const VG c = __builtin_shufflevector(in[0], in[1], 0, 3, 7, 0);
  out[0] = __builtin_shufflevector(a, in[2], 0, 1, 4, 3);
  out[1] = __builtin_shufflevector(b, in[2], 0, 5, 2, 3);
  out[2] = __builtin_shufflevector(c, in[2], 6, 1, 2, 7);
}
inline VG row_sums(const VG& a, const VG& b) {
  return __builtin_shufflevector(a, b, 0, 2, 4, 6) + __builtin_shufflevector(a, b, 1, 3, 5, 7);
}
inline VG row_sums(const VG& a, const VG& b, const VG& c) {
  const VG first = __builtin_shufflevector(a, b, 0, 3, 6, 0);
  const VG second = __builtin_shufflevector(a, b, 1, 4, 7, 0);
  const VG third = __builtin_shufflevector(a, b, 2, 5, 0, 0);
  return __builtin_shufflevector(first, c, 0, 1, 2, 5) + __builtin_shufflevector(second, c, 0, 1, 2, 6) +
         __builtin_shufflevector(third, c, 0, 1, 4, 7);
}

#endif

}  // namespace shoal::solid
