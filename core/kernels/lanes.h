// Vectors of double and single precision for the kernels. In the kernels of the tool each lane processes one
// disk, in those of depth images one pixel of a row, so the number of lanes does not change any result.
#pragma once

#include <immintrin.h>

#include <cstddef>
#include <cstdint>

// The unnamed namespace gives each file its own copy: code that is compiled for a newer machine must not be
// linked into a program for an older one.
namespace remote_touch {

namespace {

#if defined(__AVX512F__)
constexpr int kDoubles = 8;
#elif defined(__AVX2__)
constexpr int kDoubles = 4;
#else
constexpr int kDoubles = 2;
#endif
using Doubles __attribute__((vector_size(8 * kDoubles))) = double;
using Flags __attribute__((vector_size(8 * kDoubles))) = long;  // true: all bits of a lane set; false: none
using Counts __attribute__((vector_size(4 * kDoubles))) = std::int32_t;

inline Doubles broadcast(double value) {
  return Doubles{} + value;
}
inline Doubles load(const double* p) {
  Doubles a;
  __builtin_memcpy(&a, p, sizeof a);
  return a;
}
inline void store(double* p, Doubles a) {
  __builtin_memcpy(p, &a, sizeof a);
}

#if defined(__AVX512F__)
inline Doubles root(Doubles a) {
  return _mm512_sqrt_pd(a);
}
inline Doubles larger(Doubles a, Doubles b) {
  return _mm512_max_pd(a, b);
}
inline Doubles smaller(Doubles a, Doubles b) {
  return _mm512_min_pd(a, b);
}
inline unsigned mask_of(Flags flags) {
  return _mm512_movepi64_mask((__m512i)flags);
}
inline Counts toward_zero(Doubles a) {
  return __builtin_convertvector(a, Counts);
}
inline Doubles as_doubles(Counts a) {
  return __builtin_convertvector(a, Doubles);
}
#elif defined(__AVX2__)
inline Doubles root(Doubles a) {
  return _mm256_sqrt_pd(a);
}
inline Doubles larger(Doubles a, Doubles b) {
  return _mm256_max_pd(a, b);
}
inline Doubles smaller(Doubles a, Doubles b) {
  return _mm256_min_pd(a, b);
}
inline unsigned mask_of(Flags flags) {
  return static_cast<unsigned>(_mm256_movemask_pd((__m256d)flags));
}
inline Counts toward_zero(Doubles a) {
  return (Counts)_mm256_cvttpd_epi32(a);
}
inline Doubles as_doubles(Counts a) {
  return _mm256_cvtepi32_pd((__m128i)a);
}
#else
inline Doubles root(Doubles a) {
  return _mm_sqrt_pd(a);
}
inline Doubles larger(Doubles a, Doubles b) {
  return _mm_max_pd(a, b);
}
inline Doubles smaller(Doubles a, Doubles b) {
  return _mm_min_pd(a, b);
}
inline unsigned mask_of(Flags flags) {
  return static_cast<unsigned>(_mm_movemask_pd((__m128d)flags));
}
inline Counts toward_zero(Doubles a) {
  return Counts{static_cast<std::int32_t>(a[0]), static_cast<std::int32_t>(a[1])};
}
inline Doubles as_doubles(Counts a) {
  return Doubles{static_cast<double>(a[0]), static_cast<double>(a[1])};
}
#endif
inline bool is_any(Flags flags) {
  return mask_of(flags) != 0;
}

// A divisor that is used several times. The quotient is computed from the rounded reciprocal if there is
// fused multiplication and addition. It is the same as that of a division, bit for bit, in a third of the
// time: after the first step it is within one unit in the last place of the exact quotient, so that the next
// remainder is exact, and the second step rounds to the nearest (Markstein 1990). pre: the divisor is
// positive; the numbers are finite, apart from lanes that are not used; no quotient or remainder is
// subnormal.
struct Divisor {
  Doubles value;
#if defined(__FMA__)
  Doubles reciprocal;
  explicit Divisor(Doubles by) : value(by), reciprocal(1 / by) {}
#else
  explicit Divisor(Doubles by) : value(by) {}
#endif
  explicit Divisor(double by) : Divisor(broadcast(by)) {}
};

#if defined(__FMA__)
inline Doubles fused(Doubles a, Doubles b, Doubles c) {  // a b + c, rounded once
#if defined(__AVX512F__)
  return _mm512_fmadd_pd(a, b, c);
#else
  return _mm256_fmadd_pd(a, b, c);
#endif
}
inline Doubles operator/(Doubles a, const Divisor& by) {
  const Doubles rough = a * by.reciprocal;
  const Doubles near = fused(fused(-by.value, rough, a), by.reciprocal, rough);
  const Doubles quotient = fused(fused(-by.value, near, a), by.reciprocal, near);
  return a == 0 ? a : quotient;  // keeps the sign of a zero
}
#else
inline Doubles operator/(Doubles a, const Divisor& by) {
  return a / by.value;
}
#endif

inline Flags lane_numbers() {
  Flags numbers{};
  for (int lane = 0; lane < kDoubles; ++lane) numbers[lane] = lane;
  return numbers;
}
inline double least(Doubles a) {
  double min = a[0];
  for (int lane = 1; lane < kDoubles; ++lane) min = a[lane] < min ? a[lane] : min;
  return min;
}

// Stores the flagged lanes of vectors one after the other, without gaps.
class Packing {
 public:
  explicit Packing(Flags flags) : mask_(mask_of(flags)) {}

  std::size_t count() const { return static_cast<std::size_t>(__builtin_popcount(mask_)); }
  // Other lanes may be stored after the flagged ones: p needs room for kDoubles numbers.
  void put(Doubles a, double* p) const;

 private:
  unsigned mask_;
};

#if defined(__AVX512F__)
inline void Packing::put(Doubles a, double* p) const {
  // The compressing store instruction is avoided, because it needs a hundred cycles on some processors.
  store(p, _mm512_maskz_compress_pd(static_cast<__mmask8>(mask_), a));
}
#elif defined(__AVX2__)
inline void Packing::put(Doubles a, double* p) const {
  // The indices of the 32-bit halves of the flagged lanes, one byte each, for each mask.
  static constexpr std::uint64_t kOrder[16] = {
      0x0706050403020100, 0x0706050403020100, 0x0706050403020302, 0x0706050403020100,
      0x0706050403020504, 0x0706050405040100, 0x0706050405040302, 0x0706050403020100,
      0x0706050403020706, 0x0706050407060100, 0x0706050407060302, 0x0706070603020100,
      0x0706050407060504, 0x0706070605040100, 0x0706070605040302, 0x0706050403020100};
  const __m256i order = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(kOrder[mask_])));
  store(p, (Doubles)_mm256_permutevar8x32_epi32((__m256i)a, order));
}
#else
inline void Packing::put(Doubles a, double* p) const {
  store(p, mask_ == 2 ? Doubles{a[1], a[1]} : a);
}
#endif

struct Doubles3 {
  Doubles x, y, z;
};

// The three terms are added in the order in which Eigen adds them.
inline Doubles dot(const Doubles3& a, const Doubles3& b) {
  return a.x * b.x + (a.y * b.y + a.z * b.z);
}
inline Doubles3 operator+(const Doubles3& a, const Doubles3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Doubles3 operator-(const Doubles3& a, const Doubles3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Doubles3 operator*(Doubles s, const Doubles3& a) {
  return {s * a.x, s * a.y, s * a.z};
}
inline Doubles3 operator/(const Doubles3& a, const Divisor& s) {
  return {a.x / s, a.y / s, a.z / s};
}
inline Doubles3 operator-(const Doubles3& a) {
  return {-a.x, -a.y, -a.z};
}
inline Doubles3 chosen(Flags flags, const Doubles3& a, const Doubles3& b) {
  return {flags ? a.x : b.x, flags ? a.y : b.y, flags ? a.z : b.z};
}
inline Doubles norm(const Doubles3& a) {
  return root(dot(a, a));
}
inline Doubles magnitude(Doubles a) {
  return (Doubles)((Flags)a & 0x7fffffffffffffff);
}

#if defined(__AVX512F__)
constexpr int kFloats = 16;
#elif defined(__AVX2__)
constexpr int kFloats = 8;
#else
constexpr int kFloats = 4;
#endif
using Floats __attribute__((vector_size(4 * kFloats))) = float;

inline Floats load(const float* p) {
  Floats a;
  __builtin_memcpy(&a, p, sizeof a);
  return a;
}
inline void store(float* p, Floats a) {
  __builtin_memcpy(p, &a, sizeof a);
}

#if defined(__AVX512F__)
inline Floats root(Floats a) {
  return _mm512_sqrt_ps(a);
}
inline Floats larger(Floats a, Floats b) {
  return _mm512_max_ps(a, b);
}
inline Floats smaller(Floats a, Floats b) {
  return _mm512_min_ps(a, b);
}
#elif defined(__AVX2__)
inline Floats root(Floats a) {
  return _mm256_sqrt_ps(a);
}
inline Floats larger(Floats a, Floats b) {
  return _mm256_max_ps(a, b);
}
inline Floats smaller(Floats a, Floats b) {
  return _mm256_min_ps(a, b);
}
#else
inline Floats root(Floats a) {
  return _mm_sqrt_ps(a);
}
inline Floats larger(Floats a, Floats b) {
  return _mm_max_ps(a, b);
}
inline Floats smaller(Floats a, Floats b) {
  return _mm_min_ps(a, b);
}
#endif

// Calls work(kFirst) to work(kLast). The calls are unrolled here, because compilers do not unroll such short
// loops.
template <int kFirst, int kLast, class Work>
__attribute__((always_inline)) inline void unrolled(const Work& work) {
  if constexpr (kFirst <= kLast) {
    work(kFirst);
    unrolled<kFirst + 1, kLast>(work);
  }
}

// Calls work(i) for i = 1 .. half. kHalf is half, or 0 if half is not known at compile time.
template <int kHalf, class Work>
__attribute__((always_inline)) inline void for_each_step(int half, const Work& work) {
  if constexpr (kHalf > 0)
    unrolled<1, kHalf>(work);
  else
    for (int i = 1; i <= half; ++i) work(i);
}

// The weights of the pairs of points of one row, which depth_kernels.h describes. There is a row of weights
// for each (below, across). It holds the pairs whose lower point is below * step rows under the upper point
// and across * step columns to its right, at the column of the upper point.
class PairWeights {
 public:
  PairWeights(float* scratch, int width, int half, int step, int row)
      : across_((width + 4 * half + 2 * 16) / 16 * 16) {
    const int taps = half / step;
    for (int below = 1, before = 0; below <= taps; before += step * below + 1, ++below) {
      const int rows = step * below + 1;
      const auto at = [&](int upper_row) {
        const int slot = before + (upper_row + 64 * rows) % rows;
        return scratch + (slot * (2 * taps + 1) + taps) * across_ + 2 * half;
      };
      fresh_[below] = at(row), kept_[below] = at(row - step * below);
    }
  }
  // Returns the row for pairs of points in this row with points below; to be written.
  float* fresh(int below, int across) const { return fresh_[below] + across * across_; }
  // Returns the row for pairs of points above with points in this row; written earlier.
  const float* kept(int above, int across) const { return kept_[above] + across * across_; }

 private:
  std::ptrdiff_t across_;  // same as weight_stride(), whose linked copy could be of another level
  float* fresh_[8];
  const float* kept_[8];
};

}  // namespace

}  // namespace remote_touch
