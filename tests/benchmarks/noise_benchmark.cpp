// The normals of the noise, compared with those of the standard library.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "core/kernels/isa.h"
#include "core/kernels/kernels.h"
#include "core/kernels/noise_kernels.h"
#include "tests/benchmarks/checked_benchmark.h"
#include "tests/benchmarks/proxy_benchmark.h"

namespace remote_touch::benchmarks {
namespace {

constexpr std::size_t kNoisyPoints = 4096;
constexpr NoiseStream kStream{{1, 2}, {3, 4, 5}};

// Philox4x32-10 and Box-Muller with the standard library's functions: the three normals of one point.
Vec3 plain_normals(std::uint32_t point) {
  std::uint32_t c[4] = {point, kStream.counter[0], kStream.counter[1], kStream.counter[2]};
  std::uint32_t key[2] = {kStream.key[0], kStream.key[1]};
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t left = std::uint64_t{0xD2511F53} * c[0], right = std::uint64_t{0xCD9E8D57} * c[2];
    c[0] = static_cast<std::uint32_t>(right >> 32) ^ c[1] ^ key[0];
    c[2] = static_cast<std::uint32_t>(left >> 32) ^ c[3] ^ key[1];
    c[1] = static_cast<std::uint32_t>(right), c[3] = static_cast<std::uint32_t>(left);
    key[0] += 0x9E3779B9, key[1] += 0xBB67AE85;
  }
  const auto radius = [](std::uint32_t k) { return std::sqrt(-2 * std::log((k + 1.0) / 4294967296.0)); };
  const auto angle = [](std::uint32_t k) { return 2 * std::acos(-1.0) * (k / 4294967296.0); };
  return {radius(c[0]) * std::cos(angle(c[1])), radius(c[0]) * std::sin(angle(c[1])),
          radius(c[2]) * std::cos(angle(c[3]))};
}

struct Noise {
  std::vector<std::uint32_t> index;
  std::vector<double> x, y, z;
  Noise() : index(kNoisyPoints), x(kNoisyPoints), y(kNoisyPoints), z(kNoisyPoints) {
    for (std::size_t i = 0; i < kNoisyPoints; ++i) index[i] = static_cast<std::uint32_t>(7 * i);
  }
  void make(const Kernels& kernels) {
    kernels.noise.normals(kStream, index.data(), kNoisyPoints, x.data(), y.data(), z.data());
  }
};

bool normals_agree(const Kernels& kernels) {
  Noise noise;
  noise.make(kernels);
  for (std::size_t i = 0; i < kNoisyPoints; ++i) {
    const Vec3 made(noise.x[i], noise.y[i], noise.z[i]);
    if (!((made - plain_normals(noise.index[i])).norm() < 1e-13)) return false;
  }
  return true;
}

void count_normals(benchmark::State& state) {
  using Counter = benchmark::Counter;
  state.counters["s_per_normal"] =
      Counter(3.0 * kNoisyPoints, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

void time_standard_normals(benchmark::State& state) {
  Noise noise;
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (auto _ : state) {
    for (std::size_t i = 0; i < kNoisyPoints; ++i)
      noise.x[i] = normal(random), noise.y[i] = normal(random), noise.z[i] = normal(random);
    benchmark::ClobberMemory();
  }
  count_normals(state);
}

}  // namespace

void add_normals() {
  add("normals_standard_library", time_standard_normals);
  for (const Kernels* kernels : supported_kernels())
    add(
        std::string("normals/") + kernels->isa, [kernels] { return normals_agree(*kernels); },
        [kernels](benchmark::State& state) {
          Noise noise;
          for (auto _ : state) {
            noise.make(*kernels);
            benchmark::ClobberMemory();
          }
          count_normals(state);
        });
}

}  // namespace remote_touch::benchmarks
