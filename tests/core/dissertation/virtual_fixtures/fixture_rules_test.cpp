// Points that the fixture rules pick, and the share of each point in them.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "core/points/camera.h"
#include "core/points/colour.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::fixture_rules_test {
namespace {

using Shares = std::vector<double>;

const Vec3 kMissing = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());

using scenes::cloud_of;

void expect_near(const Shares& weights, const Shares& expected) {
  ASSERT_EQ(weights.size(), expected.size());
  for (std::size_t i = 0; i < weights.size(); ++i) EXPECT_NEAR(weights[i], expected[i], 1e-12) << i;
}

// --- everywhere ---

TEST(Everywhere, PicksWhatWasMeasured) {
  EXPECT_EQ(Everywhere({}).weights(cloud_of({{0, 0, 0}, kMissing, {1e6, -1e6, 3}})), (Shares{1, 0, 1}));
  EXPECT_EQ(Everywhere({}).weights({}), Shares{});
}

// --- half-space ---

TEST(HalfSpace, ThePlaneBelongsToIt) {
  HalfSpace::Settings s;
  s.point_m = {0.5, 7, -7};  // any point of the plane x = 0.5 will do
  const double below = std::nextafter(0.5, 0), above = std::nextafter(0.5, 1);
  EXPECT_EQ(HalfSpace(s).weights(cloud_of({{0.5, 0, 0}, {below, 0, 0}, {above, 0, 0}, kMissing, {9, 1, 2}})),
            (Shares{1, 0, 1, 0, 1}));
}

TEST(HalfSpace, TheNormalPointsIntoIt) {
  HalfSpace::Settings s;
  s.normal = {0, -1, 0};
  EXPECT_EQ(HalfSpace(s).weights(cloud_of({{3, 0.1, 0}, {3, -0.1, 0}, {-3, 0, 5}})), (Shares{0, 1, 1}));
}

TEST(HalfSpace, TheShareRisesEvenlyOverTheTransition) {
  HalfSpace::Settings s;
  s.point_m = {0, 1, 0}, s.normal = {0, 1, 0}, s.transition_m = 0.2;
  const auto at = [](double y) { return Vec3(4, y, -4); };
  expect_near(HalfSpace(s).weights(cloud_of({at(0.9), at(1), at(1.05), at(1.1), at(1.15), at(1.2), at(3)})),
              {0, 0, 0.25, 0.5, 0.75, 1, 1});
  EXPECT_EQ(HalfSpace(s).weights(cloud_of({kMissing})), Shares{0});
}

// Distances are along the unit normal, whatever its length in the settings.
TEST(HalfSpace, TheLengthOfTheNormalDoesNotMatter) {
  const PointCloud cloud = cloud_of({{1, 0, 0}, {0.1, 0.1, 0}, {-0.1, 0.05, 0}, {0.05, 0.02, 3}});
  HalfSpace::Settings s;
  s.normal = {3, 4, 0}, s.transition_m = 0.2;  // 5 long
  const Shares expected{1, 0.14 / 0.2, 0, 0.046 / 0.2};
  expect_near(HalfSpace(s).weights(cloud), expected);
  for (const double length : {1e-6, 1e5}) {
    s.normal = length * Vec3(3, 4, 0);
    expect_near(HalfSpace(s).weights(cloud), expected);
  }
}

TEST(HalfSpace, ANormalWithoutLengthIsRefused) {
  HalfSpace::Settings s;
  EXPECT_EQ(validate(s), "");
  s.normal = {0, 0, 0};
  EXPECT_HAS(validate(s), "normal: expected longer than 0");
}

// --- near-point ---

TEST(NearPoint, PicksPointsUpToItsRadius) {
  NearPoint::Settings s;
  s.point_m = {1, 2, 3}, s.inner_radius_m = 0.25;
  const auto beside = [&](double x) { return Vec3(1 + x, 2, 3); };
  EXPECT_EQ(
      NearPoint(s).weights(cloud_of(
          {beside(0), beside(0.25), beside(-0.25), beside(0.25 + 1e-9), {1 + 0.2, 2 + 0.2, 3}, kMissing})),
      (Shares{1, 1, 1, 0, 0, 0}));
  s.inner_radius_m = 0;
  EXPECT_EQ(NearPoint(s).weights(cloud_of({beside(0), beside(1e-9)})), (Shares{1, 0}));
}

TEST(NearPoint, FallsEvenlyToNothingBeyond) {
  NearPoint::Settings s;
  s.inner_radius_m = 0.1, s.falloff_m = 0.4;
  const auto along = [](double z) { return Vec3(0, 0, -z); };
  expect_near(NearPoint(s).weights(cloud_of({along(0.05), along(0.1), along(0.2), along(0.3), along(0.4),
                                             along(0.5), along(9), kMissing})),
              {1, 1, 0.75, 0.5, 0.25, 0, 0, 0});
}

// A wall 1 m away in 6 x 4 pixels, a point every 0.1 m; points at the holes are missing.
PointCloud wall(const std::vector<std::pair<int, int>>& holes = {}) {
  PointCloud cloud;
  cloud.image = ImageLayout{{6, 4, 10, 10, 2, 1}, RigidTransform::Identity(), 0};
  for (int v = 0; v < 4; ++v)
    for (int u = 0; u < 6; ++u) cloud.append(unproject(cloud.image->camera, u, v, 1));
  for (const auto& [u, v] : holes) {
    const auto i = static_cast<std::size_t>(6 * v + u);
    cloud.x[i] = cloud.y[i] = cloud.z[i] = std::numeric_limits<double>::quiet_NaN();
  }
  return cloud;
}

// Returns the number of the picked pixel, or -1 for none. The radius is so small that it holds one pixel
// only.
int picked(const PointCloud& cloud, int row, int column) {
  NearPoint::Settings s;
  s.row = row, s.column = column, s.inner_radius_m = 0.05;
  const Shares weights = NearPoint(s).weights(cloud);
  int found = -1;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] == 0) continue;
    EXPECT_EQ(found, -1) << "two pixels are picked";
    found = static_cast<int>(i);
  }
  return found;
}

TEST(NearPoint, APixelPicksWhatItSees) {
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 6; ++column) EXPECT_EQ(picked(wall(), row, column), 6 * row + column);
}

TEST(NearPoint, ThePointIsNotReadIfAPixelIsGiven) {
  NearPoint::Settings s;
  s.row = 1, s.column = 2, s.point_m = {0.3, 0.2, 1}, s.inner_radius_m = 0.05;
  const Shares weights = NearPoint(s).weights(wall());
  EXPECT_EQ(weights[6 * 1 + 2], 1);
  EXPECT_EQ(weights[6 * 3 + 5], 0);
}

TEST(NearPoint, AHolePicksTheNearestPixelThatSawSomething) {
  EXPECT_EQ(picked(wall({{2, 1}, {1, 1}, {2, 0}, {2, 2}}), 1, 2), 6 * 1 + 3);
  EXPECT_EQ(picked(wall({{2, 1}, {1, 1}, {3, 1}, {2, 2}}), 1, 2), 6 * 0 + 2);
  EXPECT_EQ(picked(wall({{2, 1}, {1, 1}, {3, 1}, {2, 0}}), 1, 2), 6 * 2 + 2);
  // A diagonal neighbour is nearer than the second one in the row.
  EXPECT_EQ(picked(wall({{2, 1}, {1, 1}, {3, 1}, {2, 0}, {2, 2}, {1, 0}, {3, 0}, {1, 2}}), 1, 2), 6 * 2 + 3);
  EXPECT_EQ(picked(wall({{0, 0}}), 0, 0) % 5, 1);  // one of its two neighbours, 1 and 6
}

TEST(NearPoint, ACloudOfHolesPicksNothing) {
  PointCloud holes = wall();
  holes.x.assign(holes.size(), std::nan("")), holes.y = holes.x, holes.z = holes.x;
  EXPECT_EQ(picked(holes, 1, 1), -1);
}

TEST(NearPoint, APixelOutsideTheImageIsRefused) {
  const auto why = [](const PointCloud& cloud, int row, int column) {
    return refusal([&] { picked(cloud, row, column); });
  };
  EXPECT_EQ(why(wall(), 4, 0), "near-point: row, column: expected below 4 and 6");
  EXPECT_EQ(why(wall(), 0, 6), "near-point: row, column: expected below 4 and 6");
  EXPECT_EQ(why(wall(), 3, 5), "no InputError");
  EXPECT_HAS(why(cloud_of({{0, 0, 0}}), 0, 0), "the frame is not an image");
}

TEST(NearPoint, ARowNeedsItsColumn) {
  NearPoint::Settings s;
  EXPECT_EQ(validate(s), "");
  s.row = 0;
  EXPECT_HAS(validate(s), "row and column: expected both 0 or more, or both -1");
  s.column = 0;
  EXPECT_EQ(validate(s), "");
  s.row = -1;
  EXPECT_HAS(validate(s), "row and column");
}

// --- hue-range ---

Shares of_colours(const HueRange::Settings& s, const std::vector<std::uint32_t>& colours) {
  PointCloud cloud;
  for (const std::uint32_t colour : colours) cloud.append({0, 0, 0}), cloud.colour.push_back(colour);
  return HueRange(s).weights(cloud);
}

HueRange::Settings hues(double from_deg, double to_deg) {
  HueRange::Settings s;
  s.from_deg = from_deg, s.to_deg = to_deg;
  return s;
}

constexpr std::uint32_t kRed = 0xFF0000, kYellow = 0xFFFF00, kGreen = 0x00FF00, kCyan = 0x00FFFF,
                        kBlue = 0x0000FF, kPurple = 0xFF00FF;
const std::vector<std::uint32_t> kSixths{kRed, kYellow, kGreen, kCyan, kBlue, kPurple};

TEST(HueRange, BothEndsBelongToIt) {
  EXPECT_EQ(of_colours(hues(60, 180), kSixths), (Shares{0, 1, 1, 1, 0, 0}));
  EXPECT_EQ(of_colours(hues(60.001, 179.999), kSixths), (Shares{0, 0, 1, 0, 0, 0}));
  EXPECT_EQ(of_colours(hues(120, 120), kSixths), (Shares{0, 0, 1, 0, 0, 0}));
  EXPECT_EQ(of_colours(hues(0, 360), kSixths), (Shares{1, 1, 1, 1, 1, 1}));
}

TEST(HueRange, GoesThroughZeroWhereItEndsBelowItsBeginning) {
  EXPECT_EQ(of_colours(hues(300, 60), kSixths), (Shares{1, 1, 0, 0, 0, 1}));
  EXPECT_EQ(of_colours(hues(300.001, 59.999), kSixths), (Shares{1, 0, 0, 0, 0, 0}));
  EXPECT_EQ(of_colours(hues(180, 120), kSixths), (Shares{1, 1, 1, 1, 1, 1}));
  EXPECT_EQ(of_colours({}, {kRed, 0xFF2000, 0xFF0020, kYellow, kPurple}), (Shares{1, 1, 1, 0, 0}));
}

TEST(HueRange, GreysHaveNoHue) {
  HueRange::Settings s = hues(0, 360);
  s.min_saturation = 0.2;
  EXPECT_EQ(of_colours(s, {0x7F7F7F, 0x996666, 0x996767}), (Shares{0, 1, 0}));  // 0, 51/255, 50/256
  s.min_saturation = 0;
  EXPECT_EQ(of_colours(s, {0x7F7F7F, 0x996666}), (Shares{1, 1}));
}

TEST(HueRange, DarkAndLightPointsAreNotPicked) {
  HueRange::Settings s = hues(0, 360);
  s.min_lightness = 0.2, s.max_lightness = 0.8;  // 102 and 408 of 510
  EXPECT_EQ(of_colours(s, {0x660000, 0x650000, 0xFF9999, 0xFF9A9A, kRed}), (Shares{1, 0, 1, 0, 1}));
  s.max_lightness = 0.2;
  EXPECT_EQ(of_colours(s, {0x660000, kRed}), (Shares{1, 0}));
  EXPECT_EQ(validate(s), "");
  s.min_lightness = 0.3;
  EXPECT_HAS(validate(s), "min_lightness = 0.3");
}

TEST(HueRange, AMissingPointIsNotPickedWhateverItsColour) {
  PointCloud cloud = cloud_of({kMissing, {0, 0, 0}});
  cloud.colour = {kRed, kRed};
  EXPECT_EQ(HueRange({}).weights(cloud), (Shares{0, 1}));
}

// A missing colour would be black if it counted as a colour, and no other limit would exclude it here.
TEST(HueRange, APointWithoutColourIsNotPicked) {
  HueRange::Settings s = hues(0, 360);
  s.min_saturation = 0, s.min_lightness = 0;
  EXPECT_EQ(of_colours(s, {0x000000, kNoColour, 0xFF0000}), (Shares{1, 0, 1}));
}

TEST(HueRange, AFrameWithoutColoursIsRefused) {
  EXPECT_HAS(refusal([] { HueRange({}).weights(cloud_of({{0, 0, 0}})); }), "the frame has no colours");
  EXPECT_EQ(HueRange({}).weights({}), Shares{});
}

}  // namespace
}  // namespace remote_touch::fixture_rules_test
