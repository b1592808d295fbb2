// Colours, clouds of depth images, columns of numbers, and vectors, angles and rotations against the library.
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

namespace remote_touch::point_cloud_test {
namespace {

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

// The inverse conversion of CSS Color 4, which has no cases by the largest channel.
double channel(const HueSaturationLightness& colour, double n) {
  const double k = std::fmod(n + colour.hue_deg / 30, 12);
  const double a = colour.saturation * std::min(colour.lightness, 1 - colour.lightness);
  return 255 * (colour.lightness - a * std::max(-1.0, std::min({k - 3, 9 - k, 1.0})));
}

TEST(Colour, ComesBackFromHueSaturationAndLightness) {
  for (int red = 0; red < 256; red += 5)
    for (int green = 0; green < 256; green += 3)
      for (int blue = 0; blue < 256; blue += 5) {
        const auto colour = static_cast<std::uint32_t>(red << 16 | green << 8 | blue);
        const HueSaturationLightness hsl = hue_saturation_lightness(colour);
        ASSERT_NEAR(channel(hsl, 0), red, 1e-9) << std::hex << colour;
        ASSERT_NEAR(channel(hsl, 8), green, 1e-9) << std::hex << colour;
        ASSERT_NEAR(channel(hsl, 4), blue, 1e-9) << std::hex << colour;
        ASSERT_TRUE(hsl.hue_deg >= 0 && hsl.hue_deg < 360) << std::hex << colour;
        ASSERT_TRUE(hsl.saturation >= 0 && hsl.saturation <= 1) << std::hex << colour;
        ASSERT_TRUE(red != green || green != blue || (hsl.hue_deg == 0 && hsl.saturation == 0));
        ASSERT_EQ(rgb(hsl), colour) << std::hex;
      }
  EXPECT_EQ(rgb({360, 1, 0.5}), 0xFF0000u);
}

// rebeccapurple of CSS: hsl(270, 50 %, 40 %). Bits above the three bytes are not part of the colour.
TEST(Colour, AColourOfCssHasItsHueSaturationAndLightness) {
  const HueSaturationLightness purple = hue_saturation_lightness(0xAB663399);
  EXPECT_NEAR(purple.hue_deg, 270, 1e-12);
  EXPECT_NEAR(purple.saturation, 0.5, 1e-15);
  EXPECT_NEAR(purple.lightness, 0.4, 1e-15);
}

constexpr double kPi = std::numbers::pi;
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
  DepthImage image{4, 3, std::vector<double>(12, 0.5)};
  image.z_m[5] = std::nan("");
  const PointCloud cloud = cloud_from_depth(image, kCamera, RigidTransform::Identity());
  ASSERT_EQ(cloud.size(), 12u);
  EXPECT_LT((cloud.point(11) - Vec3(0.075, 0.025, 0.5)).norm(), 1e-15);
  EXPECT_FALSE(cloud.is_measured(5));
  EXPECT_EQ(cloud_of(0, 0, 0, {}).size(), 0u);
}

TEST(CloudFromDepth, RefusesAnImageOfAnotherSize) {
  EXPECT_EQ(error_of(4, 3, 12), "");
  EXPECT_EQ(error_of(3, 4, 12), "depth image: 3 x 4 pixels: expected the camera's 4 x 3 pixels");
  for (const std::size_t depths : {0u, 11u, 13u})
    EXPECT_EQ(error_of(4, 3, depths),
              "depth image: " + std::to_string(depths) + " depths: expected one for each of 4 x 3 pixels");
}

TEST(CountingSort, ItemsOfACellAreSideBySideInTheirOrder) {
  const std::vector<std::uint32_t> cell{2, 0, 2, 3, 0, 2};
  std::vector<std::uint32_t> start(5, 77), next(5, 77), sorted(cell.size());
  sort_by_cell(
      cell.size(), start, next, [&](std::size_t i) { return cell[i]; },
      [&](std::size_t i, std::uint32_t to) { sorted[to] = static_cast<std::uint32_t>(i); });
  EXPECT_EQ(start, (std::vector<std::uint32_t>{0, 2, 2, 5, 6}));
  EXPECT_EQ(sorted, (std::vector<std::uint32_t>{1, 4, 0, 2, 5, 3}));
}

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

TEST(OrderStatistic, IsTheValueThatTheFractionLiesBelow) {
  const std::vector<double> values{5, 1, 4, 2, 3, 6};
  for (const auto& [fraction, expected] : {std::pair{0.0, 1}, {0.16, 1}, {0.34, 3}, {0.5, 4}, {0.99, 6}}) {
    std::vector<double> copy = values;
    EXPECT_EQ(quantile_in_place(copy, fraction), expected) << fraction;
  }
  std::vector<double> even{4, 1, 3, 2}, one{6};
  EXPECT_EQ(median_in_place(even), 3) << "the upper one of the two in the middle";
  EXPECT_EQ(median_in_place(one), 6);
}

TEST(LimitedLength, OnlyWhatIsLongerIsShortened) {
  EXPECT_EQ(limited_length({3, 0, 4}, 5), Vec3(3, 0, 4));
  EXPECT_EQ(limited_length({3, 0, 4}, 2.5), Vec3(1.5, 0, 2));
  EXPECT_EQ(limited_length({3, 0, 4}, 0), Vec3(0, 0, 0));
  EXPECT_EQ(limited_length({0, 0, 0}, 0), Vec3(0, 0, 0));
}

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
}  // namespace remote_touch::point_cloud_test
