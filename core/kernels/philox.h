// Philox4x32-10 (Salmon et al. 2011) in 64-bit lanes: vectors in the kernels, single words elsewhere.
#pragma once

#include <cstdint>

#include "core/kernels/point_kernels.h"

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
    Words<Vector> words[1];
    compute({point}, words);
    return words[0];
  }
  // Computes the words of several vectors of points. They are computed side by side, because each product of
  // one vector has to wait for the one before.
  template <std::size_t kCount>
  void compute(const Vector (&points)[kCount], Words<Vector> (&words)[kCount]) const {
    for (std::size_t i = 0; i < kCount; ++i) words[i] = {{points[i], b_, c_, d_}};
    for (int round = 0; round < kRounds; ++round)
      for (Words<Vector>& word : words) {
        auto& [a, b, c, d] = word.w;
        const Vector left = Product::of(a, kZero + 0xD2511F53u), right = Product::of(c, kZero + 0xCD9E8D57u);
        word = {{(right >> 32) ^ b ^ left_[round], right, (left >> 32) ^ d ^ right_[round], left}};
      }
    for (Words<Vector>& word : words)
      for (Vector& w : word.w) w &= kWord;
  }

 private:
  static constexpr int kRounds = 10;
  static constexpr Vector kZero = {};
  Vector b_, c_, d_, left_[kRounds], right_[kRounds];
};

}  // namespace
}  // namespace remote_touch
