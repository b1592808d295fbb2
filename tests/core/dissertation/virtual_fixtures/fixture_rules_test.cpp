// Points that the fixture rules pick, and the share of each point in them.

#include "core/dissertation/virtual_fixtures/fixture_rules.h"

#include <gtest/gtest.h>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "core/points/point_cloud.h"
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

TEST(Everywhere, PicksWhatWasMeasured) {
  EXPECT_EQ(Everywhere({}).weights(cloud_of({{0, 0, 0}, kMissing, {1e6, -1e6, 3}})), (Shares{1, 0, 1}));
  EXPECT_EQ(Everywhere({}).weights({}), Shares{});
}

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

// Combination of successive rules: order, blending, strength over time, and the columns of r_f and k_s.
namespace remote_touch::fixture_assignment_test {
namespace {

using Column = std::vector<double>;

// A rule that returns given weights.
class GivenWeights final : public FixtureRule {
 public:
  GivenWeights(const FixtureValues& values, Column weights)
      : FixtureRule(values), weights_(std::move(weights)) {}
  Column weights(const PointCloud&) const override { return weights_; }

 private:
  Column weights_;
};

struct Rule {
  Rule(FixtureValues v, Column s) : values(std::move(v)), weights(std::move(s)) {}
  FixtureValues values;
  Column weights;
};

FixtureAssignment assignment(const std::vector<Rule>& rules) {
  std::vector<std::unique_ptr<const FixtureRule>> list;
  for (const Rule& rule : rules) list.push_back(std::make_unique<GivenWeights>(rule.values, rule.weights));
  return FixtureAssignment(std::move(list));
}

PointCloud points(int count) {
  PointCloud cloud;
  for (int i = 0; i < count; ++i) cloud.append({0.1 * i, 0, 0});
  return cloud;
}

PointCloud assigned(const std::vector<Rule>& rules, PointCloud cloud, double captured_s = 0) {
  assignment(rules).assign(cloud, captured_s);
  return cloud;
}

void expect_near(const Column& column, const Column& expected) {
  ASSERT_EQ(column.size(), expected.size());
  for (std::size_t i = 0; i < column.size(); ++i) EXPECT_NEAR(column[i], expected[i], 1e-15) << i;
}

TEST(FixtureAssignment, ChangesNothingIfThereAreNoRules) {
  const PointCloud plain = assigned({}, points(2));
  EXPECT_TRUE(plain.fixture_radius_m.empty() && plain.stiffness_N_per_m.empty());
  PointCloud own = points(2);
  own.fixture_radius_m = {1, 2}, own.stiffness_N_per_m = {3, 4};
  const PointCloud kept = assigned({}, own);
  EXPECT_EQ(kept.fixture_radius_m, own.fixture_radius_m);
  EXPECT_EQ(kept.stiffness_N_per_m, own.stiffness_N_per_m);
  EXPECT_TRUE(assignment({}).empty() && FixtureAssignment().empty());
  EXPECT_FALSE(assignment({{{}, {1}}}).empty());
}

TEST(FixtureAssignment, PointsThatNoRulePicksHaveNoRegion) {
  EXPECT_EQ(assigned({{{0.02}, {0, 1, 0}}}, points(3)).fixture_radius_m, (Column{0, 0.02, 0}));
  EXPECT_EQ(assigned({{{0.02}, {0, 0, 0}}}, points(3)).fixture_radius_m, (Column{0, 0, 0}));
}

TEST(FixtureAssignment, TheColumnsOfTheCloudAreTheStart) {
  PointCloud cloud = points(3);
  cloud.fixture_radius_m = {0.1, 0.2, 0.3}, cloud.stiffness_N_per_m = {10, 20, 30};
  const PointCloud result = assigned({{{0.5, 40}, {0, 0.5, 1}}}, cloud);
  expect_near(result.fixture_radius_m, {0.1, 0.35, 0.5});
  expect_near(result.stiffness_N_per_m, {10, 30, 40});
  EXPECT_EQ(result.x, cloud.x);
}

TEST(FixtureAssignment, AddsNoStiffnessColumnIfNoRuleNamesAStiffness) {
  EXPECT_TRUE(assigned({{{0.02}, {1, 1}}, {{0.01}, {1, 0}}}, points(2)).stiffness_N_per_m.empty());
  PointCloud cloud = points(2);
  cloud.stiffness_N_per_m = {5, 6};
  EXPECT_EQ(assigned({{{0.02}, {1, 1}}}, cloud).stiffness_N_per_m, (Column{5, 6}));
}

// A rule fades in from the renderer's own stiffness, on the CPU and in the steps for an OpenCL device.
TEST(FixtureAssignment, AStiffnessFadesInFromTheRenderersOwn) {
  const Column weights{0, 1e-9, 0.25, 1};
  std::vector<std::unique_ptr<const FixtureRule>> rules;
  rules.push_back(std::make_unique<GivenWeights>(FixtureValues{0.02, 100}, weights));
  PointCloud cloud = points(4);
  FixtureAssignment(std::move(rules), nullptr, 300).assign(cloud, 0);
  EXPECT_TRUE(std::isnan(cloud.stiffness_N_per_m[0]));
  EXPECT_NEAR(cloud.stiffness_N_per_m[1], 300, 1e-6);
  EXPECT_EQ(cloud.stiffness_N_per_m[2], 250);
  EXPECT_EQ(cloud.stiffness_N_per_m[3], 100);
  HueRange::Settings hue;
  hue.values.stiffness_N_per_m = 100;
  rules.clear();
  rules.push_back(std::make_unique<HueRange>(hue));
  EXPECT_EQ(
      FixtureAssignment(std::move(rules), nullptr, 300).hue_steps(0, 0).value()[0].first_stiffness_N_per_m,
      300);
}

// If the renderer's own stiffness is not known, a half of it cannot be blended in.
TEST(FixtureAssignment, APointWithoutAStiffnessTakesTheRulesAtOnce) {
  const Column got = assigned({{{0.02, 100}, {0, 0.25, 1}}}, points(3)).stiffness_N_per_m;
  EXPECT_TRUE(std::isnan(got[0])) << "which is the renderer's own";
  EXPECT_EQ(got[1], 100);
  EXPECT_EQ(got[2], 100);
  // The first rule gives the point a stiffness, with which the second is blended.
  expect_near(assigned({{{0.02, 100}, {0.25}}, {{0.02, 200}, {0.25}}}, points(1)).stiffness_N_per_m, {125});
  // A stiffness of 0 is a stiffness, too.
  expect_near(assigned({{{0.02, 0}, {1}}, {{0.02, 200}, {0.25}}}, points(1)).stiffness_N_per_m, {50});
}

TEST(FixtureAssignment, ARuleWithoutAStiffnessLeavesThatOfTheRuleBefore) {
  EXPECT_EQ(assigned({{{0.02, 100}, {1}}, {{0.03}, {1}}}, points(1)).stiffness_N_per_m, Column{100});
}

TEST(FixtureAssignment, ALaterRuleOverridesAnEarlierOne) {
  const Rule first{{0.02, 100}, {1, 1, 0, 0}}, second{{0.05, 300}, {0, 1, 1, 0}};
  const PointCloud one = assigned({first, second}, points(4));
  EXPECT_EQ(one.fixture_radius_m, (Column{0.02, 0.05, 0.05, 0}));
  EXPECT_EQ(one.stiffness_N_per_m[1], 300);
  const PointCloud other = assigned({second, first}, points(4));
  EXPECT_EQ(other.fixture_radius_m, (Column{0.02, 0.02, 0.05, 0}));
  EXPECT_EQ(other.stiffness_N_per_m[1], 100);
}

TEST(FixtureAssignment, ALaterRuleCanRemoveARegion) {
  EXPECT_EQ(assigned({{{0.02}, {1, 1}}, {{0}, {1, 0}}}, points(2)).fixture_radius_m, (Column{0, 0.02}));
}

TEST(FixtureAssignment, ARuleCanLeaveTheRadiusAsItWas) {
  const PointCloud result = assigned({{{0.02}, {1, 0}}, {{-1, 300}, {1, 1}}}, points(2));
  EXPECT_EQ(result.fixture_radius_m, (Column{0.02, 0}));
  EXPECT_EQ(result.stiffness_N_per_m, (Column{300, 300}));
}

TEST(FixtureAssignment, AShareMovesTheValueOfEarlierRules) {
  expect_near(assigned({{{0.04}, {0.25, 0.5, 1}}, {{0.1}, {0.5, 0, 0.1}}}, points(3)).fixture_radius_m,
              {0.055, 0.02, 0.046});
}

TEST(FixtureAssignment, AValueThatIsReachedIsReachedExactly) {
  PointCloud cloud = points(1);
  cloud.fixture_radius_m = {0.7}, cloud.stiffness_N_per_m = {1e4};
  const PointCloud result = assigned({{{0.1, 0.3}, {1}}}, cloud);
  EXPECT_EQ(result.fixture_radius_m, Column{0.1});
  EXPECT_EQ(result.stiffness_N_per_m, Column{0.3});
}

FixtureValues scheduled(Column rows) {
  FixtureValues values{0.02};
  values.schedule = std::move(rows);
  return values;
}

double strength(const Column& rows, double time_s) {
  return Everywhere({scheduled(rows)}).strength(time_s);
}

TEST(Schedule, IsEvenBetweenRowsAndConstantOutside) {
  const Column rows{1, 0.25, 3, 0.75, 4, 0};
  const double expected[][2] = {{-5, 0.25}, {0, 0.25},    {1, 0.25}, {1.5, 0.375}, {2, 0.5},
                                {3, 0.75},  {3.5, 0.375}, {4, 0},    {4.001, 0},   {1e6, 0}};
  for (const auto& [time_s, value] : expected) EXPECT_NEAR(strength(rows, time_s), value, 1e-15) << time_s;
}

TEST(Schedule, StrengthIsOneWithoutRowsAndConstantWithOne) {
  for (const double time_s : {-1.0, 0.0, 2.0, 1e6}) {
    EXPECT_EQ(strength({}, time_s), 1);
    EXPECT_EQ(strength({2, 0.5}, time_s), 0.5);
  }
}

TEST(Schedule, JumpsWhereTwoRowsHaveTheSameTime) {
  const Column rows{1, 0, 2, 0.5, 2, 1, 2, 0.25, 3, 0.75};
  EXPECT_NEAR(strength(rows, std::nextafter(2, 0)), 0.5, 1e-12);
  EXPECT_EQ(strength(rows, 2), 0.25) << "the last row of that time counts from then on";
  EXPECT_NEAR(strength(rows, 2.5), 0.5, 1e-15);
  EXPECT_EQ(strength({0, 1, 0, 0}, 0), 0);
  EXPECT_EQ(strength({0, 1, 0, 0}, -1e-9), 1);
}

TEST(Schedule, MultipliesTheShare) {
  const Rule rule{scheduled({0, 0, 2, 1}), {1, 0.5}};
  expect_near(assigned({rule}, points(2), 0).fixture_radius_m, {0, 0});
  expect_near(assigned({rule}, points(2), 0.5).fixture_radius_m, {0.005, 0.0025});
  expect_near(assigned({rule}, points(2), 7).fixture_radius_m, {0.02, 0.01});
}

// A rule of zero strength does not give a stiffness either.
TEST(Schedule, StiffnessIsTheRenderersAtZeroStrength) {
  FixtureValues values = scheduled({1, 0, 1, 1});
  values.stiffness_N_per_m = 50;
  EXPECT_TRUE(std::isnan(assigned({{values, {1}}}, points(1), 0.5).stiffness_N_per_m.at(0)));
  EXPECT_EQ(assigned({{values, {1}}}, points(1), 1).stiffness_N_per_m.at(0), 50);
}

TEST(Schedule, AssignmentChangesWithTimeIfTheStrengthChanges) {
  const auto changes = [](const std::vector<Column>& schedules) {
    std::vector<Rule> rules;
    for (const Column& rows : schedules) rules.push_back({scheduled(rows), {1}});
    return assignment(rules).changes_with_time();
  };
  EXPECT_FALSE(changes({}));
  EXPECT_FALSE(changes({{}, {0, 0.5}, {0, 0.5, 9, 0.5}}));
  EXPECT_TRUE(changes({{}, {0, 0.5, 9, 0.6}, {}}));
  EXPECT_TRUE(changes({{0, 0.5, 1, 0.5, 1, 0.4}}));
}

TEST(FixtureValues, AreRefusedIfOutOfRangeOrOutOfOrder) {
  EXPECT_EQ(validate(FixtureValues{}), "");
  EXPECT_EQ(validate(FixtureValues{0, 0, {}}), "");
  EXPECT_EQ(validate(FixtureValues{0, -0.5, {}}), "stiffness_N_per_m = -0.500000: expected 0 or more, or -1");
  EXPECT_EQ(validate(scheduled({0, 0, 0, 1, 3, 0.5})), "");
  EXPECT_EQ(validate(scheduled({0, 0, 1, 1.5})), "schedule: strength 1.500000: expected 0 to 1");
  EXPECT_EQ(validate(scheduled({0, 1.5})), "schedule: strength 1.500000: expected 0 to 1");
  EXPECT_EQ(validate(scheduled({0, 0, 2, 1, 1, 0})),
            "schedule: time 1.000000: expected no earlier than the row before");
}

// Steps by hue are for another device.
FixtureAssignment by_hue(FixtureRole role, bool with_other_rule) {
  HueRange::Settings red, blue;
  blue.from_deg = 200, blue.to_deg = 280;
  blue.values.role = role, blue.values.radius_m = 0.03, blue.values.schedule = {0, 0, 2, 1};
  std::vector<std::unique_ptr<const FixtureRule>> rules;
  rules.push_back(std::make_unique<HueRange>(red));
  rules.push_back(std::make_unique<HueRange>(blue));
  if (with_other_rule) rules.push_back(std::make_unique<GivenWeights>(FixtureValues{}, Column{}));
  return FixtureAssignment(std::move(rules));
}

TEST(FixtureAssignment, StepsByHueAreItsRulesWithTheirStrengthThen) {
  const auto steps = by_hue(FixtureRole::forbidden, false).hue_steps(0.5, 0);
  ASSERT_TRUE(steps.has_value());
  ASSERT_EQ(steps->size(), 2u);
  EXPECT_EQ(steps->at(0).range.from_deg, 340);
  EXPECT_EQ(steps->at(0).strength, 1);
  EXPECT_EQ(steps->at(1).range.values.radius_m, 0.03);
  EXPECT_EQ(steps->at(1).strength, 0.25);
}

TEST(FixtureAssignment, StepsByHueLeaveOutRulesThatAreOff) {
  const FixtureAssignment fixtures = by_hue(FixtureRole::forbidden, false);
  const auto steps = fixtures.hue_steps(2, 1);
  ASSERT_EQ(steps.value_or(HueSteps{}).size(), 1u);
  EXPECT_EQ(steps->at(0).range.from_deg, 200);
  EXPECT_EQ(fixtures.hue_steps(2, 3).value_or(HueSteps(1)).size(), 0u);  // the column of r_f is still made
}

TEST(FixtureAssignment, ThereAreNoStepsByHueForOtherRules) {
  EXPECT_FALSE(by_hue(FixtureRole::guidance, false).hue_steps(0, 0).has_value());
  EXPECT_FALSE(by_hue(FixtureRole::forbidden, true).hue_steps(0, 0).has_value());
  EXPECT_FALSE(FixtureAssignment().hue_steps(0, 0).has_value());
}

}  // namespace
}  // namespace remote_touch::fixture_assignment_test
