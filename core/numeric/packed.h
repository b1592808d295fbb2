// Small vectors and square matrices, stored in pairs of doubles for SSE2. The bits are the same from every
// compiler and on every x86-64 machine, and the speed is about twice that of scalar code.
#pragma once

#include <emmintrin.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace remote_touch {

using Pair [[gnu::vector_size(16)]] = double;
inline Pair pair_at(const double* p) {
  Pair pair;
  std::memcpy(&pair, p, sizeof pair);
  return pair;
}
// Writes both numbers, or only the first.
inline void put(Pair pair, bool two, double* p) {
  std::memcpy(p, &pair, two ? sizeof pair : sizeof(double));
}
inline Pair root(Pair pair) {
  return _mm_sqrt_pd(pair);
}
inline Pair both(double value) {
  return Pair{value, value};
}

// A vector of N numbers in pairs. If N is odd, the second half of the last pair is zero.
template <int N>
struct Packed {
  static constexpr int kPairs = (N + 1) / 2;
  Pair pair[kPairs] = {};

  double operator[](int i) const { return pair[i / 2][i % 2]; }
  void set(int i, double value) { pair[i / 2][i % 2] = value; }
  void add(double factor, const Packed& other) {
    for (int p = 0; p < kPairs; ++p) pair[p] += both(factor) * other.pair[p];
  }
  double dot(const Packed& other) const {
    Pair sum = pair[0] * other.pair[0];
    for (int p = 1; p < kPairs; ++p) sum += pair[p] * other.pair[p];
    return sum[0] + sum[1];
  }
  double max_abs() const {
    double result = 0;
    for (int i = 0; i < N; ++i) result = std::max(result, std::abs((*this)[i]));
    return result;
  }
};

template <int N>
struct Square {
  Packed<N> column[N];

  Packed<N> times(const Packed<N>& x) const {
    Packed<N> sum;
    for (int j = 0; j < N; ++j) sum.add(x[j], column[j]);
    return sum;
  }
  Packed<N> transposed_times(const Packed<N>& x) const {
    Packed<N> result;
    for (int j = 0; j < N; ++j) result.set(j, column[j].dot(x));
    return result;
  }
  // Reflects all rows (multiplication from the right) in the hyperplane normal to v; factor is 2 / |v|^2.
  void reflect(const Packed<N>& v, double factor) {
    const Packed<N> along = times(v);
    for (int j = 0; j < N; ++j) column[j].add(-factor * v[j], along);
  }
};

}  // namespace remote_touch
