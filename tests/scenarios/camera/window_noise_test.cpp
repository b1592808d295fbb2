#include "scenarios/camera/window_noise.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "core/numeric/noise.h"
#include "tests/support/scenes.h"

namespace remote_touch::window_noise_test {
namespace {

constexpr int kWidth = 60, kHeight = 50;

WindowNoise noise(int window, std::uint32_t frame = 0, bool also_independent = true) {
  return window_noise(kWidth, kHeight, window, also_independent,
                      noise_stream(NoiseKey{7}, NoiseUse::depth, frame), scenes::kernels());
}

constexpr int kFrames = 40;

std::vector<std::vector<double>> frames(int window) {
  std::vector<std::vector<double>> all;
  for (std::uint32_t frame = 0; frame < kFrames; ++frame) all.push_back(noise(window, frame, false).averaged);
  return all;
}

// Mean product of the values of pixels that are (du, dv) apart.
double product(const std::vector<std::vector<double>>& frames, int du, int dv) {
  double sum = 0;
  int count = 0;
  for (const std::vector<double>& n : frames)
    for (int v = 0; v + dv < kHeight; ++v)
      for (int u = 0; u + du < kWidth; ++u, ++count)
        sum += n[static_cast<std::size_t>(v * kWidth + u)] *
               n[static_cast<std::size_t>((v + dv) * kWidth + u + du)];
  return sum / count;
}

// The independent pixels of a frame are fewer than all by the square of the window.
TEST(WindowNoise, ItsCorrelationIsTheOverlapOfTheWindows) {
  for (const int window : {1, 3, 7}) {
    const double tolerance = 6 * window / std::sqrt(1.0 * kFrames * kWidth * kHeight);
    const std::vector<std::vector<double>> of_window = frames(window);
    for (const int du : {0, 1, 2, 4, 6, 7, 9})
      for (const int dv : {0, 1, 5, 8}) {
        const double expected = std::max(0.0, 1 - 1.0 * du / window) * std::max(0.0, 1 - 1.0 * dv / window);
        EXPECT_NEAR(product(of_window, du, dv), expected, tolerance) << window << ": " << du << " " << dv;
      }
  }
}

TEST(WindowNoise, AWindowOfOnePixelIsTheNoiseOfTheStream) {
  const std::size_t count = kWidth * kHeight;
  std::vector<std::uint32_t> index(count);
  std::iota(index.begin(), index.end(), 0u);
  std::vector<double> x(count), y(count), z(count);
  scenes::kernels().noise.normals(noise_stream(NoiseKey{7}, NoiseUse::depth, 3), index.data(), count,
                                  x.data(), y.data(), z.data());
  const WindowNoise n = noise(1, 3);
  EXPECT_EQ(n.averaged, x);
  EXPECT_EQ(n.across, y);
  EXPECT_EQ(n.down, z);
}

TEST(WindowNoise, TheSumsAreThoseOfTheWindow) {
  const int window = 4, columns = kWidth + window - 1, rows = kHeight + window - 1;
  const auto count = static_cast<std::size_t>(columns * rows);
  std::vector<std::uint32_t> index(count);
  std::iota(index.begin(), index.end(), 0u);
  std::vector<double> x(count), y(count), z(count);
  scenes::kernels().noise.normals(noise_stream(NoiseKey{7}, NoiseUse::depth, 5), index.data(), count,
                                  x.data(), y.data(), z.data());
  const WindowNoise n = noise(window, 5);
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u) {
      double sum = 0;
      for (int j = 0; j < window; ++j)
        for (int i = 0; i < window; ++i) sum += x[static_cast<std::size_t>((v + j) * columns + u + i)];
      const auto pixel = static_cast<std::size_t>(v * kWidth + u);
      ASSERT_NEAR(n.averaged[pixel], sum / window, 1e-14);
      ASSERT_EQ(n.across[pixel], y[static_cast<std::size_t>(v * columns + u)]);
      ASSERT_EQ(n.down[pixel], z[static_cast<std::size_t>(v * columns + u)]);
    }
}

TEST(WindowNoise, TheBitsDoNotDependOnTheNumberOfThreads) {
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const WindowNoise expected = noise(7);
  omp_set_num_threads(5);
  EXPECT_EQ(noise(7).averaged, expected.averaged);
  EXPECT_EQ(noise(7).down, expected.down);
  omp_set_num_threads(threads);
  EXPECT_TRUE(noise(7, 0, false).across.empty());
}

}  // namespace
}  // namespace remote_touch::window_noise_test
