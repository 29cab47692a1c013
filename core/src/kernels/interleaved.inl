// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Row-major rows of Width numbers as Width columns, a vector of rows at a time. Included once per SIMD target.
#if defined(THALWEG_KERNELS_INTERLEAVED_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_KERNELS_INTERLEAVED_INL
#undef THALWEG_KERNELS_INTERLEAVED_INL
#else
#define THALWEG_KERNELS_INTERLEAVED_INL
#endif

#include "kernels/lanes.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3

/// Of the blocks of 4 numbers from here on, every kStride-th, one a lane of 128 bits. Masked loads blend, where
/// shuffles across lanes would crowd the one port that has them; what is left are shuffles within lanes.
template <int kStride>
HWY_INLINE __m512 load_blocks(const float* from) {
  __m512 v = _mm512_castps128_ps512(_mm_loadu_ps(from));
  v = _mm512_mask_broadcast_f32x4(v, 0x00f0, _mm_loadu_ps(from + 4 * kStride));
  v = _mm512_mask_broadcast_f32x4(v, 0x0f00, _mm_loadu_ps(from + 8 * kStride));
  return _mm512_mask_broadcast_f32x4(v, 0xf000, _mm_loadu_ps(from + 12 * kStride));
}
/// Numbers kA and kB of each lane of a, then kC and kD of each lane of b.
template <int kA, int kB, int kC, int kD>
HWY_INLINE __m512 picked(__m512 a, __m512 b) {
  return _mm512_shuffle_ps(a, b, _MM_SHUFFLE(kD, kC, kB, kA));
}

HWY_INLINE void load_interleaved(const float* rows, V32 (&columns)[2]) {
  const __m512 xyxy01 = load_blocks<2>(rows), xyxy23 = load_blocks<2>(rows + 4);
  columns[0] = V32{picked<0, 2, 0, 2>(xyxy01, xyxy23)};
  columns[1] = V32{picked<1, 3, 1, 3>(xyxy01, xyxy23)};
}
HWY_INLINE void load_interleaved(const float* rows, V32 (&columns)[3]) {
  const __m512 xyzx = load_blocks<3>(rows), yzxy = load_blocks<3>(rows + 4), zxyz = load_blocks<3>(rows + 8);
  const __m512 yz01 = picked<1, 2, 0, 1>(xyzx, yzxy), xy23 = picked<2, 3, 1, 2>(yzxy, zxyz);
  columns[0] = V32{picked<0, 3, 0, 2>(xyzx, xy23)};
  columns[1] = V32{picked<0, 2, 1, 3>(yz01, xy23)};
  columns[2] = V32{picked<1, 3, 0, 3>(yz01, zxyz)};
}
/// Two rows are three blocks; each lane has rows 0 and 1, then 2 and 3, of four.
HWY_INLINE void load_interleaved(const float* rows, V32 (&columns)[6]) {
  const auto pair = [](const float* at, __m512(&pairs)[3]) HWY_ATTR {
    const __m512 a = load_blocks<6>(at), b = load_blocks<6>(at + 4), c = load_blocks<6>(at + 8);
    pairs[0] = picked<0, 1, 2, 3>(a, b);
    pairs[1] = picked<2, 3, 0, 1>(a, c);
    pairs[2] = picked<0, 1, 2, 3>(b, c);
  };
  __m512 first[3], second[3];
  pair(rows, first);
  pair(rows + 12, second);
  for (size_t k = 0; k < 3; ++k) {
    columns[2 * k] = V32{picked<0, 2, 0, 2>(first[k], second[k])};
    columns[2 * k + 1] = V32{picked<1, 3, 1, 3>(first[k], second[k])};
  }
}

#else

HWY_INLINE void load_interleaved(const float* rows, V32 (&columns)[2]) {
  hn::LoadInterleaved2(F32(), rows, columns[0], columns[1]);
}
HWY_INLINE void load_interleaved(const float* rows, V32 (&columns)[3]) {
  hn::LoadInterleaved3(F32(), rows, columns[0], columns[1], columns[2]);
}
#if HWY_TARGET != HWY_SCALAR
/// Every third number twice over: columns k and k + 3 side by side.
HWY_INLINE void load_interleaved(const float* rows, V32 (&columns)[6]) {
  const F32 d;
  V32 low[3], high[3];
  load_interleaved(rows, low);
  load_interleaved(rows + 3 * hn::Lanes(d), high);
  for (size_t k = 0; k < 3; ++k) {
    columns[k] = hn::ConcatEven(d, high[k], low[k]);
    columns[k + 3] = hn::ConcatOdd(d, high[k], low[k]);
  }
}
#endif

#endif

HWY_INLINE void load_interleaved(const float* rows, V32 (&columns)[4]) {
  hn::LoadInterleaved4(F32(), rows, columns[0], columns[1], columns[2], columns[3]);
}
template <size_t Width>
HWY_INLINE void load_interleaved(const float* rows, V32 (&columns)[Width]) {
  const hn::RebindToSigned<F32> di;
  const auto first = hn::Mul(hn::Iota(di, 0), hn::Set(di, static_cast<int32_t>(Width)));
  for (size_t k = 0; k < Width; ++k) columns[k] = hn::GatherIndex(F32(), rows + k, first);
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
