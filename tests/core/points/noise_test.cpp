// The noise against Philox and Box-Muller in long double, on every instruction set.
#include "core/points/noise.h"
#include "core/kernels/kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "tests/support/scenes.h"

namespace remote_touch::noise_test {
namespace {

using Real = long double;
using Words = std::array<std::uint32_t, 4>;
using Key = std::array<std::uint32_t, 2>;

// Constants of Philox4x32, Salmon et al. 2011.
constexpr std::uint32_t kMultiplier[2] = {0xD2511F53, 0xCD9E8D57}, kWeyl[2] = {0x9E3779B9, 0xBB67AE85};

std::uint32_t high(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::uint32_t>((std::uint64_t{a} * b) >> 32);
}

Words philox(Words c, Key key) {
  for (int round = 0; round < 10; ++round) {
    c = {high(kMultiplier[1], c[2]) ^ c[1] ^ key[0], kMultiplier[1] * c[2],
         high(kMultiplier[0], c[0]) ^ c[3] ^ key[1], kMultiplier[0] * c[0]};
    key[0] += kWeyl[0], key[1] += kWeyl[1];
  }
  return c;
}

// Returns the counter that gives these words. Each round can be undone because the multipliers are odd.
Words philox_inverse(Words w, const Key& key) {
  std::uint32_t inverse[2];
  for (int k = 0; k < 2; ++k) {
    inverse[k] = kMultiplier[k];
    for (int i = 0; i < 5; ++i) inverse[k] *= 2 - kMultiplier[k] * inverse[k];  // Newton's iteration
  }
  for (std::uint32_t round = 10; round-- > 0;) {
    const std::uint32_t a = inverse[0] * w[3], c = inverse[1] * w[1];
    w = {a, w[0] ^ high(kMultiplier[1], c) ^ (key[0] + round * kWeyl[0]), c,
         w[2] ^ high(kMultiplier[0], a) ^ (key[1] + round * kWeyl[1])};
  }
  return w;
}

// Box-Muller on the four words: one pair, and the cosine of a second.
std::array<Real, 3> box_muller(const Words& w) {
  const auto radius = [](std::uint32_t k) { return std::sqrt(-2 * std::log((Real{1} + k) * 0x1p-32L)); };
  const auto angle = [](std::uint32_t k) { return 2 * std::acos(Real{-1}) * (k * 0x1p-32L); };
  return {radius(w[0]) * std::cos(angle(w[1])), radius(w[0]) * std::sin(angle(w[1])),
          radius(w[2]) * std::cos(angle(w[3]))};
}

using Normals = std::array<std::vector<double>, 3>;

Normals draw(const NoiseStream& stream, const std::vector<std::uint32_t>& index,
             const Kernels& kernels = scenes::kernels()) {
  Normals n;
  for (auto& column : n) column.resize(index.size());
  kernels.noise.normals(stream, index.data(), index.size(), n[0].data(), n[1].data(), n[2].data());
  return n;
}

std::vector<std::uint32_t> first_points(std::size_t count) {
  std::vector<std::uint32_t> index(count);
  std::iota(index.begin(), index.end(), 0u);
  return index;
}

// A normal is at most 6.7 and comes from a few double operations of 1e-15 each at that size.
constexpr double kRounding = 1e-14;

TEST(Noise, ReferenceHasTheKnownValuesOfRandom123) {
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox({~0u, ~0u, ~0u, ~0u}, {~0u, ~0u}),
            (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Noise, IsPhiloxAndBoxMullerOfTheKey) {
  std::vector<std::uint32_t> index = first_points(2000);
  for (std::size_t i = 0; i < index.size(); ++i) index[i] *= 2147483u;  // the whole range, wrapping round
  const NoiseKey key{0x123456789abcdef0, 4000000001, 17};
  for (const NoiseUse use : {NoiseUse::point_position, NoiseUse::depth})
    for (const std::uint32_t frame : {0u, 25u, (1u << 28) - 1})
      for (const Kernels* kernels : supported_kernels()) {
        const Normals got = draw(noise_stream(key, use, frame), index, *kernels);
        const std::uint32_t word = frame | (use == NoiseUse::depth ? 1u << 28 : 0u);
        for (std::size_t i = 0; i < index.size(); ++i) {
          const auto want = box_muller(philox({index[i], word, 4000000001, 17}, {0x9abcdef0, 0x12345678}));
          for (std::size_t k = 0; k < 3; ++k)
            ASSERT_NEAR(got[k][i], static_cast<double>(want[k]), kRounding) << index[i];
        }
      }
}

// Words at the seams of the logarithm and of the quarter turns. The inverse generator gives the counters that
// produce them.
TEST(Noise, IsRightAtTheEndsAndSeamsOfItsFunctions) {
  const Key key{1, 2};
  std::vector<std::uint32_t> lengths{0, 1, 2, 0x55555554, 0x55555555, 0x7fffffff, 0x80000000, ~0u - 1, ~0u};
  for (std::uint32_t k = 0xaaaaaaa8; k < 0xaaaaaaad; ++k) lengths.push_back(k);  // u = 2/3
  std::vector<std::uint32_t> angles;
  for (std::uint32_t eighth = 0; eighth < 8; ++eighth)
    for (const std::uint32_t beside : {~0u, 0u, 1u}) angles.push_back((eighth << 29) + beside);
  for (const Kernels* kernels : supported_kernels())
    for (const std::uint32_t length : lengths)
      for (const std::uint32_t angle : angles) {
        const Words words{length, angle, lengths[angle % lengths.size()], ~angle};
        const Words counter = philox_inverse(words, key);
        ASSERT_EQ(philox(counter, key), words);
        const Normals got =
            draw({{key[0], key[1]}, {counter[1], counter[2], counter[3]}}, {counter[0]}, *kernels);
        const auto want = box_muller(words);
        for (std::size_t k = 0; k < 3; ++k)
          ASSERT_NEAR(got[k][0], static_cast<double>(want[k]), kRounding) << length << " " << angle;
      }
}

TEST(Noise, BoundIsTightAndHolds) {
  const Words counter = philox_inverse({0, 0, 0, 0x80000000}, {7, 8});
  const Normals max = draw({{7, 8}, {counter[1], counter[2], counter[3]}}, {counter[0]});
  EXPECT_NEAR(max[0][0], static_cast<double>(std::sqrt(64 * std::log(Real{2}))), kRounding);
  EXPECT_NEAR(max[2][0], -static_cast<double>(std::sqrt(64 * std::log(Real{2}))), kRounding);
  EXPECT_LT(max[0][0], kMaxNormal);
  EXPECT_GT(max[0][0], kMaxNormal - 1e-3);
}

TEST(Noise, HasTheSameBitsForAnySubsetInAnyOrderOnEveryLevel) {
  const NoiseStream stream = noise_stream({3, 1, 4}, NoiseUse::point_position, 9);
  const Normals all = draw(stream, first_points(1000));
  std::vector<std::uint32_t> shuffled = first_points(1000);
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(1));
  for (const std::size_t count : {1, 3, 7, 8, 9, 100, 613}) {
    const std::vector<std::uint32_t> some(shuffled.end() - static_cast<std::ptrdiff_t>(count),
                                          shuffled.end());
    for (const Kernels* kernels : supported_kernels()) {
      const Normals few = draw(stream, some, *kernels);
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(few[k][i], all[k][some[i]]) << kernels->isa;
    }
  }
}

// Every point whose normals match the request is found. Other points are found only if their words leave it
// open.
TEST(Noise, CandidatesAreFoundByTheirWords) {
  // The last vector of a row has lanes without a point, and the rows are parts of longer ones.
  constexpr std::size_t kColumns = 197, kRows = 203, kCount = kColumns * kRows;
  constexpr PointRectangle kPoints{.first = 12345, .stride = 211, .columns = kColumns, .rows = kRows};
  const NoiseStream stream = noise_stream({5, 2, 1}, NoiseUse::point_position, 3);
  std::vector<std::uint32_t> every;
  for (std::uint32_t row = 0; row < kRows; ++row)
    for (std::uint32_t column = 0; column < kColumns; ++column)
      every.push_back(kPoints.first + row * kPoints.stride + column);
  const Normals normals = draw(stream, every);
  for (const double x : {0.0, 0.5, -2.0, 3.5})
    for (const double z : {0.0, 1.0, -2.5}) {
      // The bounds differ from column to column and from row to row: every second one has the other sign.
      const auto sided = [](double bound, std::size_t i) { return i % 2 == 0 ? bound : -bound; };
      std::vector<std::uint64_t> x_bounds(kColumns + kLanes), z_bounds(kRows);
      for (std::size_t i = 0; i < kColumns; ++i) x_bounds[i] = word_bounds(std::abs(x), sided(x, i));
      for (std::size_t i = 0; i < kRows; ++i) z_bounds[i] = word_bounds(std::abs(z), sided(z, i));
      std::vector<std::vector<std::uint32_t>> found;
      for (const Kernels* kernels : supported_kernels()) {
        found.emplace_back(kCount + kLanes);
        found.back().resize(kernels->noise.candidates(stream, kPoints, x_bounds.data(), z_bounds.data(),
                                                      found.back().data()));
        ASSERT_EQ(found.back(), found.front()) << kernels->isa;
      }
      const auto is_asked = [](double normal, double min) {
        return min == 0 || (min > 0 ? normal >= min : normal <= min);
      };
      const auto has_sign = [](double normal, double min) { return min == 0 || (normal > 0) == (min > 0); };
      std::size_t next = 0;
      for (std::size_t i = 0; i < kCount; ++i) {
        const bool is_found = next < found[0].size() && found[0][next] == every[i];
        next += is_found ? 1 : 0;
        const double nx = normals[0][i], nz = normals[2][i];
        const double x_min = sided(x, i % kColumns), z_min = sided(z, i / kColumns);
        const bool must = is_asked(nx, x_min) && is_asked(nz, z_min);
        const bool must_not = std::hypot(nx, normals[1][i]) < std::abs(x) - 1e-5 || !has_sign(nx, x_min) ||
                              !has_sign(nz, z_min);
        ASSERT_TRUE(is_found ? !must_not : !must) << i;
      }
      const double halves = (x == 0 ? 1 : 0.5) * (z == 0 ? 1 : 0.5);
      const double expected = halves * kCount * std::exp(-0.5 * (x * x + z * z));
      EXPECT_NEAR(static_cast<double>(found[0].size()), expected, 5 * std::sqrt(expected) + 1);
    }
}

TEST(Uniforms, AreTheWordsOfPhilox) {
  const NoiseKey key{0x123456789abcdef0, 4000000001, 17};
  for (const std::uint32_t frame : {0u, 25u, (1u << 28) - 1})
    for (const std::uint32_t point : {0u, 1u, 77u, ~0u}) {
      const auto got = uniforms(noise_stream(key, NoiseUse::transport, frame), point);
      const Words want = philox({point, frame | 2u << 28, 4000000001, 17}, {0x9abcdef0, 0x12345678});
      for (std::size_t k = 0; k < 4; ++k)
        EXPECT_EQ(got[k], static_cast<double>((static_cast<Real>(want[k]) + 0.5L) * 0x1p-32L))
            << frame << " " << point;
    }
}

TEST(Uniforms, LieBetweenZeroAndOneAlsoAtTheEnds) {
  for (const std::uint32_t word : {0u, ~0u}) {
    const Words counter = philox_inverse({word, word, word, word}, {7, 8});
    for (const double u : uniforms({{7, 8}, {counter[1], counter[2], counter[3]}}, counter[0]))
      EXPECT_EQ(u, word == 0 ? 0x1p-33 : 1 - 0x1p-33);
  }
}

// The formula of the reference is checked too: Kolmogorov-Smirnov at 0.1 %.
TEST(Noise, IsStandardNormal) {
  const std::size_t count = 200000;
  const double n = static_cast<double>(count);
  for (std::vector<double>& column : draw(noise_stream({11}, NoiseUse::depth, 2), first_points(count))) {
    std::sort(column.begin(), column.end());
    double distance = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double cumulative = 0.5 * std::erfc(-column[i] / std::sqrt(2.0)), rank = static_cast<double>(i);
      distance = std::max({distance, cumulative - rank / n, (rank + 1) / n - cumulative});
    }
    EXPECT_LT(distance * std::sqrt(n), 1.95);
  }
}

}  // namespace
}  // namespace remote_touch::noise_test
