// The pixels at which a device can touch a depth image, compared with plain loops over all pixels.
#include "runners/experiment/hand/surface_support.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace remote_touch::surface_support_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kFocal_px = 250;
const CameraIntrinsics kCamera{.fx = kFocal_px, .fy = kFocal_px};
const CameraIntrinsics kUnequal{.fx = kFocal_px, .fy = kFocal_px / 2};

std::size_t pixel(const DepthImage& image, int u, int v) {
  return static_cast<std::size_t>(v) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(u);
}

// Uneven by less than 4 mm, with a step of 1 cm at column 24 and a hole.
DepthImage uneven(double z_m) {
  DepthImage image{40, 31, std::vector<double>(40 * 31)};
  for (int v = 0; v < image.height; ++v)
    for (int u = 0; u < image.width; ++u)
      image.z_m[pixel(image, u, v)] = z_m + 5e-4 * ((7 * u + 3 * v) % 8) + (u < 24 ? 0 : 0.01);
  image.z_m[pixel(image, 9, 15)] = kNaN;
  return image;
}

// Median of the depths of the rectangle. NaN unless every pixel of it is joined to those to its left and
// above it.
double plain_depth(const DepthImage& image, int u, int v, int across, int down, double edge_jump_m) {
  const auto at = [&](int x, int y) {
    const bool is_inside = x >= 0 && y >= 0 && x < image.width && y < image.height;
    return is_inside ? image.z_m[pixel(image, x, y)] : kNaN;
  };
  std::vector<double> seen;
  for (int y = v - down; y <= v + down; ++y)
    for (int x = u - across; x <= u + across; ++x) {
      const bool is_joined = std::abs(at(x, y) - at(x - 1, y)) <= edge_jump_m &&
                             std::abs(at(x, y) - at(x, y - 1)) <= edge_jump_m;
      if (!is_joined) return kNaN;
      seen.push_back(at(x, y));
    }
  std::sort(seen.begin(), seen.end());
  return seen[seen.size() / 2];
}

// 1 cm is 6 pixels across and 3 down at 0.4 m, 2 and 1 at 1 m, and less than one, which counts as one, at
// 5 m. If any jump is allowed, a pixel that is read outside the image is no edge, so no pixel outside may be
// read.
TEST(SurfaceSupport, IsTheMedianOfASquareWithoutHolesEdgesAndBorders) {
  const struct {
    double z_m;
    int across, down;
  } cases[] = {{0.4, 6, 3}, {1, 2, 1}, {5, 1, 1}};
  for (const auto& c : cases)
    for (const double edge_jump_m : {0.006, std::numeric_limits<double>::infinity()}) {
      const DepthImage image = uneven(c.z_m);
      int supported = 0;
      for (int v = 0; v < image.height; ++v)
        for (int u = 0; u < image.width; ++u) {
          const double got = supported_depth(image, u, v, kUnequal, {edge_jump_m, 0.01});
          const double expected = plain_depth(image, u, v, c.across, c.down, edge_jump_m);
          EXPECT_TRUE(got == expected || (std::isnan(got) && std::isnan(expected)))
              << got << " instead of " << expected << " at " << u << ", " << v << ", " << c.z_m << " m";
          supported += std::isfinite(expected);
        }
      EXPECT_GT(supported, 100);
    }
}

TEST(SurfaceSupport, HasNoDepthOutsideTheImageAndAtTheLens) {
  DepthImage image{9, 9, std::vector<double>(9 * 9, 1.0)};
  for (const auto& [u, v] : {std::pair(-1, 4), {9, 4}, {4, -1}, {4, 9}})
    EXPECT_TRUE(std::isnan(supported_depth(image, u, v, kCamera, {}))) << u << ", " << v;
  for (const double z_m : {1e-300, 0.0, -1.0}) {  // the margin would be more pixels than an int holds
    image.z_m[pixel(image, 4, 4)] = z_m;
    EXPECT_TRUE(std::isnan(supported_depth(image, 4, 4, kCamera, {0.01, 0.01}))) << z_m;
  }
}

TEST(SurfaceSupport, ALengthReachesOnePixelAtLeastAndTheImageAtMost) {
  const DepthImage image{40, 31, {}};
  EXPECT_EQ(reach_px(image, kFocal_px, 0.01, 0.4), 6);
  EXPECT_EQ(reach_px(image, kFocal_px, 0.01, 5), 1);
  EXPECT_EQ(reach_px(image, kFocal_px, 0.01, 1e-300), 40);
  EXPECT_EQ(reach_px(image, kFocal_px, 0.01, kNaN), 1);
}

// Compared with the distances of all pixels that the plain loop supports.
TEST(SurfaceSupport, FindsTheNearestPixelThatCanBeTouched) {
  const DepthImage image = uneven(1);
  for (const ImagePixel& to : {ImagePixel{15, 9}, {15, 24}, {0, 0}, {30, 39}, {14, 30}}) {
    const auto squared = [&](int u, int v) {
      return (u - to.column) * (u - to.column) + (v - to.row) * (v - to.row);
    };
    int least = std::numeric_limits<int>::max();
    for (int v = 0; v < image.height; ++v)
      for (int u = 0; u < image.width; ++u)
        if (std::isfinite(plain_depth(image, u, v, 2, 2, 0.006))) least = std::min(least, squared(u, v));
    const auto found = nearest_supported(image, to, kCamera, {0.006, 0.01});
    ASSERT_TRUE(found);
    EXPECT_TRUE(std::isfinite(plain_depth(image, found->column, found->row, 2, 2, 0.006)));
    EXPECT_EQ(squared(found->column, found->row), least) << to.row << ", " << to.column;
  }
  EXPECT_FALSE(nearest_supported(image, {15, 9}, kCamera, {0.006, 0.1})) << "25 pixels in every direction";
}

// A whole image in memory, followed by rows that are not its own.
TEST(SurfaceSupport, ReadsNoRowBelowTheImage) {
  DepthImage image{9, 9, std::vector<double>(9 * 12, 1.0)};
  EXPECT_EQ(supported_depth(image, 4, 6, kCamera, {}), 1);
  EXPECT_TRUE(std::isnan(supported_depth(image, 4, 7, kCamera, {})));
}

}  // namespace
}  // namespace remote_touch::surface_support_test
