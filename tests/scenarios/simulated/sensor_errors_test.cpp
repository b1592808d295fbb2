#include "scenarios/simulated/depth_camera.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "core/points/noise.h"
#include "tests/support/scenes.h"

namespace remote_touch::sensor_errors_test {
namespace {

constexpr double kFocal_px = 500, kBaseline_m = 0.08, kEdge_m = 0.02;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::vector<char> shadow_of_row(const std::vector<double>& z_m) {
  return baseline_shadow({static_cast<int>(z_m.size()), 1, z_m}, kFocal_px * kBaseline_m, kEdge_m);
}

// Far surface, then a near one of some columns, then the far one again.
std::vector<double> object_before_wall(int width, int first, int columns, double near_m, double far_m) {
  std::vector<double> z(static_cast<std::size_t>(width), far_m);
  for (int u = first; u < first + columns; ++u) z[static_cast<std::size_t>(u)] = near_m;
  return z;
}

// Positions in the plane of the row: x to the right, z forward.
using Point = Eigen::Vector2d;
double side(const Point& a, const Point& b, const Point& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}
bool cross(const Point& a, const Point& b, const Point& c, const Point& d) {
  return side(a, b, c) * side(a, b, d) <= 0 && side(c, d, a) * side(c, d, b) <= 0;
}

// The surfaces of a row as straight pieces in metres, each with its pixel.
struct Piece {
  Point from, to;
  int pixel;
};
std::vector<Piece> pieces(const std::vector<double>& z) {
  const auto point = [](double u, double depth) { return Point(u / kFocal_px * depth, depth); };
  std::vector<Piece> all;
  const int width = static_cast<int>(z.size());
  const auto connected = [&](int u) {
    return u >= 0 && u + 1 < width && std::abs(z[u] - z[u + 1]) <= kEdge_m;
  };
  for (int u = 0; u < width; ++u) {
    if (std::isnan(z[u])) continue;
    if (!connected(u - 1)) all.push_back({point(u - 0.5, z[u]), point(u, z[u]), u});
    all.push_back({point(u, z[u]), connected(u) ? point(u + 1, z[u + 1]) : point(u + 0.5, z[u]), u});
  }
  return all;
}

// A point is hidden if the way from it to the device meets a piece, other than its own two, or if the device
// is behind the surface to its right.
bool is_hidden(const std::vector<double>& z, const std::vector<Piece>& all, int u) {
  const Point p(u / kFocal_px * z[u], z[u]), device(kBaseline_m, 0);
  for (const Piece& piece : all) {
    if (piece.from == p) {
      if (side(p, piece.to, device) >= 0) return true;
    } else if (piece.to != p && piece.pixel > u && cross(p, device, piece.from, piece.to)) {
      return true;
    }
  }
  return false;
}

TEST(BaselineShadow, IsThatOfRaysToTheDevice) {
  std::mt19937 random(3);
  const auto uniform = [&] { return random() / 4294967296.0; };
  int hidden = 0, seen = 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<double> z;
    double depth = 1, slope = 0;
    for (int u = 0; u < 120; ++u) {
      if (uniform() < 0.08) depth = 0.5 + uniform(), slope = 0.016 * (uniform() - 0.5);
      if (uniform() < 0.05) slope = 0.036 * (uniform() - 0.5);
      depth = std::max(0.4, depth + slope);
      z.push_back(uniform() < 0.03 ? kNaN : depth + 1e-6 * uniform());
    }
    const std::vector<char> shadow = shadow_of_row(z);
    const std::vector<Piece> all = pieces(z);
    for (int u = 0; u < 120; ++u) {
      if (std::isnan(z[u])) continue;
      ASSERT_EQ(shadow[u] != 0, is_hidden(z, all, u)) << trial << " " << u;
      (shadow[u] ? hidden : seen) += 1;
    }
  }
  EXPECT_GT(hidden, 2000);
  EXPECT_GT(seen, 2000);
}

TEST(BaselineShadow, ItsWidthIsTheDifferenceOfTheDisparities) {
  for (const double near_m : {0.5, 0.6, 0.8})
    for (const double far_m : {0.9, 1.3}) {
      const std::vector<char> shadow = shadow_of_row(object_before_wall(400, 200, 150, near_m, far_m));
      const double width = kBaseline_m * kFocal_px * (1 / near_m - 1 / far_m);
      int count = 0;
      for (int u = 0; u < 400; ++u) {
        count += shadow[u];
        EXPECT_TRUE(!shadow[u] || (u < 200 && u >= 200 - width - 1)) << u;
      }
      EXPECT_NEAR(count, width, 1);
    }
}

TEST(BaselineShadow, ANarrowObjectHasAShadowOfItsOwnWidthBesideIt) {
  const std::vector<char> shadow = shadow_of_row(object_before_wall(300, 200, 10, 0.5, 1));  // 40 px away
  for (int u = 0; u < 300; ++u) EXPECT_EQ(shadow[u] != 0, u >= 160 && u < 170) << u;
}

TEST(BaselineShadow, APlaneHasNone) {
  std::vector<double> slanted;
  for (int u = 0; u < 300; ++u) slanted.push_back(1 / (1 + 0.003 * u));  // a plane: 1 / z is affine in u
  for (const char hidden : shadow_of_row(slanted)) EXPECT_EQ(hidden, 0);
  for (const char hidden : shadow_of_row(std::vector<double>(50, 0.7))) EXPECT_EQ(hidden, 0);
}

TEST(BaselineShadow, ASurfaceThatTurnsItsBackToTheDeviceIsHidden) {
  std::vector<double> steep;  // the disparity grows by 1.2 px for each pixel to the right
  for (int u = 0; u < 40; ++u) steep.push_back(1 / (1 + 1.2 * u / (kFocal_px * kBaseline_m)));
  const std::vector<char> shadow = baseline_shadow({40, 1, steep}, kFocal_px * kBaseline_m, 1);
  for (int u = 0; u < 39; ++u) EXPECT_EQ(shadow[u], 1) << u;
  EXPECT_EQ(shadow[39], 0);
}

TEST(BaselineShadow, RowsAreIndependent) {
  const std::vector<double> first = object_before_wall(100, 60, 30, 0.5, 1),
                            second = object_before_wall(100, 70, 5, 0.7, 0.9);
  DepthImage image{100, 2, first};
  image.z_m.insert(image.z_m.end(), second.begin(), second.end());
  const std::vector<char> both = baseline_shadow(image, kFocal_px * kBaseline_m, kEdge_m);
  EXPECT_EQ(std::vector<char>(both.begin(), both.begin() + 100), shadow_of_row(first));
  EXPECT_EQ(std::vector<char>(both.begin() + 100, both.end()), shadow_of_row(second));
}

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
}  // namespace remote_touch::sensor_errors_test
