// Vectors of double precision for the tool's kernels: a lane is a disk, so that their number does not change
// any result.
#pragma once

#include <immintrin.h>

#include <cstddef>
#include <cstdint>

// A copy for every file: code that is compiled for a newer machine must not be linked in for an older one.
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
using Flags __attribute__((vector_size(8 * kDoubles))) = long;  // of a comparison: all bits set, or none
using Counts __attribute__((vector_size(4 * kDoubles))) = std::int32_t;

inline Doubles all(double value) {
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
inline bool is_any(Flags flags) {
  return _mm512_movepi64_mask((__m512i)flags) != 0;
}
inline Counts toward_zero(Doubles a) {
  return (Counts)_mm512_cvttpd_epi32(a);
}
inline Doubles as_doubles(Counts a) {
  return _mm512_cvtepi32_pd((__m256i)a);
}
#elif defined(__AVX2__)
inline Doubles root(Doubles a) {
  return _mm256_sqrt_pd(a);
}
inline bool is_any(Flags flags) {
  return _mm256_movemask_pd((__m256d)flags) != 0;
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
inline bool is_any(Flags flags) {
  return _mm_movemask_pd((__m128d)flags) != 0;
}
inline Counts toward_zero(Doubles a) {
  return Counts{static_cast<std::int32_t>(a[0]), static_cast<std::int32_t>(a[1])};
}
inline Doubles as_doubles(Counts a) {
  return Doubles{static_cast<double>(a[0]), static_cast<double>(a[1])};
}
#endif

struct Doubles3 {
  Doubles x, y, z;
};

// Sums of three terms in the order in which Eigen adds them.
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
inline Doubles3 operator/(const Doubles3& a, Doubles s) {
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

}  // namespace
}  // namespace remote_touch
