// Vectors of single precision for the depth kernels. Each lane processes one pixel of a row, so the number of
// lanes does not change any result.
#pragma once

#include <immintrin.h>

#include <cstddef>

// The unnamed namespace gives each file its own copy: code that is compiled for a newer machine must not be
// linked into a program for an older one.
namespace remote_touch {
namespace {

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
