// Philox4x32-10 (Salmon et al. 2011) in 64-bit lanes: vectors in the kernels, single words elsewhere.
#pragma once

#include <cstdint>

#include "core/kernels/noise_kernels.h"

// The unnamed namespace gives each file its own copy: code that is compiled for a newer machine must not be
// linked into a program for an older one.
namespace remote_touch {
namespace {

constexpr std::uint64_t kWord = 0xFFFFFFFFu;

template <class Vector>
struct Words {
  Vector w[4];
};

// The generator of one stream, with the keys of its rounds precomputed. Product::of(a, b) multiplies the
// lower halves of lanes.
template <class Vector, class Product>
class Philox {
 public:
  explicit Philox(const NoiseStream& stream)
      : b_(kZero + stream.counter[0]), c_(kZero + stream.counter[1]), d_(kZero + stream.counter[2]) {
    std::uint32_t left = stream.key[0], right = stream.key[1];
    for (int round = 0; round < kRounds; ++round, left += 0x9E3779B9u, right += 0xBB67AE85u)
      left_[round] = kZero + left, right_[round] = kZero + right;
  }
  Words<Vector> operator()(Vector point) const {
    Vector a = point, b = b_, c = c_, d = d_;
    for (int round = 0; round < kRounds; ++round) {
      const Vector left = Product::of(a, kZero + 0xD2511F53u), right = Product::of(c, kZero + 0xCD9E8D57u);
      a = (right >> 32) ^ b ^ left_[round];
      c = (left >> 32) ^ d ^ right_[round];
      b = right, d = left;
    }
    return {{a & kWord, b & kWord, c & kWord, d & kWord}};
  }

 private:
  static constexpr int kRounds = 10;
  static constexpr Vector kZero = {};
  Vector b_, c_, d_, left_[kRounds], right_[kRounds];
};

}  // namespace
}  // namespace remote_touch
