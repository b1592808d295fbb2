#include "core/points/point_cloud.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/points/number_columns.h"
#include "core/points/vector.h"

// Hue, saturation and lightness: known colours, and back to red, green and blue.
namespace remote_touch::colour_test {
namespace {

// Checks hue, saturation and lightness, the last two in [0, 1]. An undefined hue is expected as 0.
void expect_colour(std::uint32_t rgb, double hue_deg, double saturation, double lightness) {
  const HueSaturationLightness colour = hue_saturation_lightness(rgb);
  EXPECT_NEAR(colour.hue_deg, hue_deg, 1e-12) << std::hex << rgb;
  EXPECT_NEAR(colour.saturation, saturation, 1e-15) << std::hex << rgb;
  EXPECT_NEAR(colour.lightness, lightness, 1e-15) << std::hex << rgb;
}

TEST(Colour, TheCornersOfTheCubeAreKnown) {
  expect_colour(0xFF0000, 0, 1, 0.5);
  expect_colour(0xFFFF00, 60, 1, 0.5);
  expect_colour(0x00FF00, 120, 1, 0.5);
  expect_colour(0x00FFFF, 180, 1, 0.5);
  expect_colour(0x0000FF, 240, 1, 0.5);
  expect_colour(0xFF00FF, 300, 1, 0.5);
  expect_colour(0x000000, 0, 0, 0);
  expect_colour(0xFFFFFF, 0, 0, 1);
  expect_colour(0xAB00FF00, 120, 1, 0.5);  // bits above the three bytes are not part of the colour
}

// PCL writes 0x00RRGGBB, or opaque colours as 0xFFRRGGBB. The values from 0xFF800001 on are NaN as floats.
TEST(Colour, AFloatHoldsAColourOrNone) {
  for (const std::uint32_t rgb : {0x000000u, 0x0000FFu, 0x7F8000u, 0xC00001u, 0xFFFFFFu})
    for (const std::uint32_t alpha : {0x00u, 0xFFu}) EXPECT_EQ(colour_of_float(alpha << 24 | rgb), rgb);
  EXPECT_EQ(colour_of_float(0x00C00000), 0xC00000u);
  for (const std::uint32_t none :
       {0x7FC00000u, 0xFFC00000u, 0x7F800000u, 0x437F0000u, 0x4A808060u})  // nan -nan inf 255 4210736
    EXPECT_EQ(colour_of_float(none), kNoColour) << std::hex << none;
}

TEST(Colour, UnknownIsShownAsGreyAndNotAsBlack) {
  EXPECT_EQ(shown_colour(kNoColour), 0x808080u);
  for (const std::uint32_t rgb : {0x000000u, 0xC00000u, 0xFFFFFFu}) EXPECT_EQ(shown_colour(rgb), rgb);
}

// Worked out by hand.
TEST(Colour, MixedColoursAreKnown) {
  expect_colour(0x7F7F7F, 0, 0, 127 / 255.0);
  expect_colour(0xFF8000, 60 * 128 / 255.0, 1, 0.5);
  expect_colour(0xFF0080, 360 - 60 * 128 / 255.0, 1, 0.5);
  expect_colour(0xFFCCCC, 0, 1, 459 / 510.0);      // pale, but as pure as that lightness allows
  expect_colour(0x330000, 0, 1, 51 / 510.0);       // dark, the same
  expect_colour(0x996666, 0, 51 / 255.0, 0.5);     // a mix of red and grey
  expect_colour(0x663399, 270, 0.5, 204 / 510.0);  // rebeccapurple of CSS: hsl(270, 50 %, 40 %)
}

// The inverse conversion of CSS Color 4, which has no cases by the largest channel.
double channel(const HueSaturationLightness& colour, double n) {
  const double k = std::fmod(n + colour.hue_deg / 30, 12);
  const double a = colour.saturation * std::min(colour.lightness, 1 - colour.lightness);
  return 255 * (colour.lightness - a * std::max(-1.0, std::min({k - 3, 9 - k, 1.0})));
}

TEST(Colour, TheInverseGivesTheSameColourBack) {
  for (std::uint32_t colour = 0; colour <= 0xFFFFFF; colour += 997)
    ASSERT_EQ(rgb(hue_saturation_lightness(colour)), colour) << std::hex << colour;
  EXPECT_EQ(rgb({360, 1, 0.5}), 0xFF0000u);
}

TEST(Colour, ComesBackFromHueSaturationAndLightness) {
  for (int red = 0; red < 256; red += 5)
    for (int green = 0; green < 256; green += 3)
      for (int blue = 0; blue < 256; blue += 5) {
        const auto rgb = static_cast<std::uint32_t>(red << 16 | green << 8 | blue);
        const HueSaturationLightness colour = hue_saturation_lightness(rgb);
        ASSERT_NEAR(channel(colour, 0), red, 1e-9) << std::hex << rgb;
        ASSERT_NEAR(channel(colour, 8), green, 1e-9) << std::hex << rgb;
        ASSERT_NEAR(channel(colour, 4), blue, 1e-9) << std::hex << rgb;
        ASSERT_TRUE(colour.hue_deg >= 0 && colour.hue_deg < 360) << std::hex << rgb;
        ASSERT_TRUE(colour.saturation >= 0 && colour.saturation <= 1) << std::hex << rgb;
        ASSERT_TRUE(colour.lightness >= 0 && colour.lightness <= 1) << std::hex << rgb;
      }
}

// A colour's angle around the grey axis is another measure of hue. Both are equal at every sixth of the
// circle and differ by at most 1.2 degrees in between.
TEST(Colour, HueIsNearlyTheAngleAroundTheGreyAxis) {
  for (int red = 0; red < 256; red += 15)
    for (int green = 0; green < 256; green += 15)
      for (int blue = 0; blue < 256; blue += 15) {
        if (red == green && green == blue) continue;
        const double angle =
            std::atan2(std::sqrt(3.0) * (green - blue), 2.0 * red - green - blue) * 180 / std::numbers::pi;
        const auto rgb = static_cast<std::uint32_t>(red << 16 | green << 8 | blue);
        EXPECT_LT(std::abs(std::remainder(hue_saturation_lightness(rgb).hue_deg - angle, 360)), 1.2)
            << std::hex << rgb;
      }
}

}  // namespace
}  // namespace remote_touch::colour_test

namespace remote_touch::camera_test {
namespace {

constexpr CameraIntrinsics kCamera{4, 3, 10, 20, 1.5, 1};

PointCloud cloud_of(int width, int height, std::size_t depths, const CameraIntrinsics& camera = kCamera) {
  return cloud_from_depth({width, height, std::vector<double>(depths, 0.5)}, camera,
                          RigidTransform::Identity());
}

std::string error_of(int width, int height, std::size_t depths) {
  try {
    cloud_of(width, height, depths);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

TEST(CloudFromDepth, EveryPixelIsAPointOnItsRay) {
  const PointCloud cloud = cloud_of(4, 3, 12);
  ASSERT_EQ(cloud.size(), 12u);
  EXPECT_LT((cloud.point(11) - Vec3(0.075, 0.025, 0.5)).norm(), 1e-15);
  DepthImage hole{4, 3, std::vector<double>(12, 0.5)};
  hole.z_m[5] = std::nan("");
  EXPECT_FALSE(cloud_from_depth(hole, kCamera, RigidTransform::Identity()).is_measured(5));
}

TEST(CloudFromDepth, RefusesAnImageOfAnotherSize) {
  EXPECT_EQ(error_of(4, 3, 12), "");
  EXPECT_EQ(error_of(3, 4, 12), "depth image: 3 x 4 pixels: expected the camera's 4 x 3 pixels");
  EXPECT_EQ(error_of(4, 3, 11), "depth image: 11 depths: expected one for each of 4 x 3 pixels");
  EXPECT_EQ(error_of(4, 3, 13), "depth image: 13 depths: expected one for each of 4 x 3 pixels");
  EXPECT_EQ(error_of(4, 3, 0), "depth image: 0 depths: expected one for each of 4 x 3 pixels");
}

TEST(CloudFromDepth, AnImageWithoutPixelsIsAnEmptyCloud) {
  EXPECT_EQ(cloud_of(0, 0, 0, {}).size(), 0u);
}

}  // namespace
}  // namespace remote_touch::camera_test

namespace remote_touch::counting_sort_test {
namespace {

TEST(CountingSort, ItemsOfACellAreSideBySideInTheirOrder) {
  const std::vector<std::uint32_t> cell{2, 0, 2, 3, 0, 2};
  std::vector<std::uint32_t> start(5, 77), next(5, 77), sorted(cell.size());
  sort_by_cell(
      cell.size(), start, next, [&](std::size_t i) { return cell[i]; },
      [&](std::size_t i, std::uint32_t to) { sorted[to] = static_cast<std::uint32_t>(i); });
  EXPECT_EQ(start, (std::vector<std::uint32_t>{0, 2, 2, 5, 6}));
  EXPECT_EQ(sorted, (std::vector<std::uint32_t>{1, 4, 0, 2, 5, 3}));
}

TEST(CountingSort, EveryCellIsEmptyIfThereAreNoItems) {
  std::vector<std::uint32_t> start(3, 77), next(3);
  sort_by_cell(
      0, start, next, [](std::size_t) { return 0u; }, [](std::size_t, std::uint32_t) { FAIL(); });
  EXPECT_EQ(start, (std::vector<std::uint32_t>{0, 0, 0}));
}

}  // namespace
}  // namespace remote_touch::counting_sort_test

namespace remote_touch::whole_lines_test {
namespace {

TEST(WholeLines, ColumnsBeginAtALineAndKeepTheirNumbers) {
  for (const std::size_t size : {1u, 7u, 100u, 100000u}) {
    LineVector<double> column(1, 0.0), other;
    for (std::size_t i = 1; i < size; ++i) {
      column.push_back(static_cast<double>(i));
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(column.data()) % kLineBytes, 0u);
    }
    other = column;
    EXPECT_EQ(other, column);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(other.data()) % kLineBytes, 0u);
  }
}

}  // namespace
}  // namespace remote_touch::whole_lines_test

namespace remote_touch::order_statistic_test {
namespace {

double quantile_of(std::vector<double> values, double fraction) {
  return quantile_in_place(values, fraction);
}

TEST(OrderStatistic, IsTheValueThatTheFractionLiesBelow) {
  const std::vector<double> values{5, 1, 4, 2, 3};
  EXPECT_EQ(quantile_of(values, 0), 1);
  EXPECT_EQ(quantile_of(values, 0.19), 1);
  EXPECT_EQ(quantile_of(values, 0.4), 3);
  EXPECT_EQ(quantile_of(values, 0.99), 5);
}

TEST(OrderStatistic, MedianOfAnEvenNumberIsTheUpperOne) {
  std::vector<double> odd{9, 7, 8}, even{4, 1, 3, 2}, one{6};
  EXPECT_EQ(median_in_place(odd), 8);
  EXPECT_EQ(median_in_place(even), 3);
  EXPECT_EQ(median_in_place(one), 6);
}

}  // namespace
}  // namespace remote_touch::order_statistic_test

namespace remote_touch::vector_test {
namespace {

TEST(BoundingBox, IsAroundEveryPosition) {
  const BoundingBox box = bounding_box(std::vector<Vec3>{{1, -2, 3}, {-1, 5, 3}, {0, 0, 4}});
  EXPECT_EQ(box.min(), Vec3(-1, -2, 3));
  EXPECT_EQ(box.max(), Vec3(1, 5, 4));
  EXPECT_TRUE(bounding_box(std::vector<Vec3>{}).isEmpty());
}

TEST(LimitedLength, OnlyWhatIsLongerIsShortened) {
  EXPECT_EQ(limited_length({3, 0, 4}, 5), Vec3(3, 0, 4));
  EXPECT_EQ(limited_length({3, 0, 4}, 2.5), Vec3(1.5, 0, 2));
  EXPECT_EQ(limited_length({3, 0, 4}, 0), Vec3(0, 0, 0));
  EXPECT_EQ(limited_length({0, 0, 0}, 0), Vec3(0, 0, 0));
}

}  // namespace
}  // namespace remote_touch::vector_test

namespace remote_touch::rotation_test {
namespace {

const double kPi = std::acos(-1.0);

TEST(Rotation, SineAndCosineAreThoseOfTheLibrary) {
  for (double angle = -50; angle < 50; angle += 0.00137) {
    const auto [s, c] = sin_cos(angle);
    ASSERT_NEAR(s, std::sin(angle), 3e-16) << angle;
    ASSERT_NEAR(c, std::cos(angle), 3e-16) << angle;
  }
  for (double angle = -9.9e5; angle < 9.9e5; angle += 1371.7) {
    ASSERT_NEAR(sin_cos(angle).first, std::sin(angle), 3e-16) << angle;
    ASSERT_NEAR(sin_cos(angle).second, std::cos(angle), 3e-16) << angle;
  }
  EXPECT_EQ(sin_cos(0).first, 0);
  EXPECT_EQ(sin_cos(0).second, 1);
}

TEST(Rotation, TurnsAboutItsAxisByItsLength) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 axis = Vec3(normal(random), normal(random), normal(random)).normalized();
    const double angle = 3 * normal(random);
    const Eigen::Quaterniond q = rotation(angle * axis);
    EXPECT_NEAR(q.norm(), 1, 4e-16);
    const Eigen::Matrix3d expected = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    EXPECT_LT((q.toRotationMatrix() - expected).norm(), 5e-15);
  }
  EXPECT_EQ(rotation(Vec3::Zero()).coeffs(), Eigen::Quaterniond::Identity().coeffs());
}

TEST(Rotation, VectorIsTheShortestOfTheRotation) {
  for (const double angle : {0.0, 1e-300, 1e-12, 1e-3, 0.5, 1.5, 3.0, kPi - 1e-9}) {
    const Vec3 vector = angle * Vec3(2, -1, 2) / 3;
    EXPECT_LT((rotation_vector(rotation(vector)) - vector).norm(), 1e-15 * (1 + angle)) << angle;
    // The same rotation, written the other way.
    const Eigen::Quaterniond q = rotation(vector), other(-q.w(), -q.x(), -q.y(), -q.z());
    EXPECT_LT((rotation_vector(other) - vector).norm(), 1e-15 * (1 + angle)) << angle;
  }
  const Vec3 far = 1.5 * kPi * Vec3::UnitX();
  EXPECT_LT((rotation_vector(rotation(far)) + 0.5 * kPi * Vec3::UnitX()).norm(), 1e-15);
}

}  // namespace
}  // namespace remote_touch::rotation_test

namespace remote_touch::angle_test {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(AngleBetween, IsThatOfTheLibraryForRandomVectors) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 a(normal(random), normal(random), normal(random));
    const Vec3 b(normal(random), normal(random), normal(random));
    const double expected = std::atan2(a.cross(b).norm(), a.dot(b));
    ASSERT_NEAR(angle_between(1e-3 * a, 1e3 * b), expected, 2e-15) << i;
    ASSERT_EQ(angle_between(a, b), angle_between(b, a));
  }
}

// Acos of the dot product would lose half of the digits at both ends.
TEST(AngleBetween, IsExactAtBothEnds) {
  for (const double angle : {1e-12, 1e-8, 1e-4, 0.1, kPi / 2, 3.0}) {
    const Vec3 a(2, 0, 0), b(std::cos(angle), std::sin(angle), 0);
    EXPECT_NEAR(angle_between(a, b), angle, 2e-15) << angle;
    EXPECT_NEAR(angle_between(a, -b), kPi - angle, 2e-15) << angle;
  }
  EXPECT_EQ(angle_between(Vec3(1, 2, 3), Vec3(2, 4, 6)), 0);
  EXPECT_NEAR(angle_between(Vec3(1, 2, 3), Vec3(-1, -2, -3)), kPi, 2e-15);
  EXPECT_NEAR(angle_between(Vec3(1, 0, 0), Vec3(0, 1, 0)), kPi / 2, 2e-15);
}

}  // namespace
}  // namespace remote_touch::angle_test
