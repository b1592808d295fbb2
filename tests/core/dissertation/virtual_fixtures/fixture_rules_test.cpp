// Points that the fixture rules pick, the share of each point in them, and the columns of r_f and k_s that
// successive rules make.
#include "core/dissertation/virtual_fixtures/fixture_rules.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/points/point_cloud.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::fixture_rules_test {
namespace {

using Column = std::vector<double>;
using scenes::cloud_of;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
const Vec3 kMissing = Vec3::Constant(kNaN);

// NaN is equal to NaN.
void expect_near(const Column& column, const Column& expected, double tolerance) {
  ASSERT_EQ(column.size(), expected.size());
  for (std::size_t i = 0; i < column.size(); ++i)
    if (!std::isnan(column[i]) || !std::isnan(expected[i])) {
      EXPECT_NEAR(column[i], expected[i], tolerance) << i;
    }
}

// --- shares of places ---

template <class Rule>
struct Shares {
  const char* what;
  typename Rule::Settings settings;
  std::vector<Vec3> points;
  Column expected;
};

template <class Rule>
void expect_shares(const std::vector<Shares<Rule>>& cases) {
  for (const Shares<Rule>& c : cases) {
    SCOPED_TRACE(c.what);
    expect_near(Rule(c.settings).weights(cloud_of(c.points)), c.expected, 1e-12);
  }
}

TEST(Everywhere, PicksWhatWasMeasured) {
  expect_shares<Everywhere>(
      {{"three points", {}, {{0, 0, 0}, kMissing, {1e6, -1e6, 3}}, {1, 0, 1}}, {"no point", {}, {}, {}}});
}

HalfSpace::Settings half_space(const Vec3& point_m, const Vec3& normal, double transition_m = 0) {
  return {{}, point_m, normal, transition_m};
}

// Distances are along the unit normal, whatever its length in the settings.
TEST(HalfSpace, TheShareRisesFromThePlaneAlongTheNormal) {
  const double below = std::nextafter(0.5, 0), above = std::nextafter(0.5, 1);
  const auto at = [](double y) { return Vec3(4, y, -4); };
  const std::vector<Vec3> beside{{1, 0, 0}, {0.1, 0.1, 0}, {-0.1, 0.05, 0}, {0.05, 0.02, 3}};
  const Column shares{1, 0.14 / 0.2, 0, 0.046 / 0.2};
  expect_shares<HalfSpace>({{"the plane belongs to it",
                             half_space({0.5, 7, -7}, {1, 0, 0}),
                             {{0.5, 0, 0}, {below, 0, 0}, {above, 0, 0}, kMissing, {9, 1, 2}},
                             {1, 0, 1, 0, 1}},
                            {"the normal points into it",
                             half_space({0, 0, 0}, {0, -1, 0}),
                             {{3, 0.1, 0}, {3, -0.1, 0}, {-3, 0, 5}},
                             {0, 1, 1}},
                            {"a transition",
                             half_space({0, 1, 0}, {0, 1, 0}, 0.2),
                             {at(0.9), at(1), at(1.05), at(1.1), at(1.15), at(1.2), at(3), kMissing},
                             {0, 0, 0.25, 0.5, 0.75, 1, 1, 0}},
                            {"normal 5 long", half_space({0, 0, 0}, {3, 4, 0}, 0.2), beside, shares},
                            {"short normal", half_space({0, 0, 0}, {3e-6, 4e-6, 0}, 0.2), beside, shares},
                            {"long normal", half_space({0, 0, 0}, {3e5, 4e5, 0}, 0.2), beside, shares}});
}

NearPoint::Settings near_point(const Vec3& point_m, double inner_radius_m, double falloff_m = 0) {
  NearPoint::Settings s;
  s.point_m = point_m, s.inner_radius_m = inner_radius_m, s.falloff_m = falloff_m;
  return s;
}

TEST(NearPoint, PicksPointsUpToItsRadiusAndFallsEvenlyBeyond) {
  const auto beside = [](double x) { return Vec3(1 + x, 2, 3); };
  const auto along = [](double z) { return Vec3(0, 0, -z); };
  expect_shares<NearPoint>(
      {{"without falloff",
        near_point({1, 2, 3}, 0.25),
        {beside(0), beside(0.25), beside(-0.25), beside(0.25 + 1e-9), {1.2, 2.2, 3}, kMissing},
        {1, 1, 1, 0, 0, 0}},
       {"radius 0", near_point({1, 2, 3}, 0), {beside(0), beside(1e-9)}, {1, 0}},
       {"with falloff",
        near_point({0, 0, 0}, 0.1, 0.4),
        {along(0.05), along(0.1), along(0.2), along(0.3), along(0.4), along(0.5), along(9), kMissing},
        {1, 1, 0.75, 0.5, 0.25, 0, 0, 0}}});
}

// A wall 1 m away in 6 x 4 pixels, a point every 0.1 m; points at the holes are missing.
PointCloud wall(const std::vector<std::pair<int, int>>& holes = {}) {
  PointCloud cloud;
  cloud.image = ImageLayout{{6, 4, 10, 10, 2, 1}, RigidTransform::Identity(), 0};
  for (int v = 0; v < 4; ++v)
    for (int u = 0; u < 6; ++u) cloud.append(unproject(cloud.image->camera, u, v, 1));
  for (const auto& [u, v] : holes) {
    const auto i = static_cast<std::size_t>(6 * v + u);
    cloud.x[i] = cloud.y[i] = cloud.z[i] = kNaN;
  }
  return cloud;
}

// Returns the number of the picked pixel, or -1 for none. The radius is so small that it holds one pixel
// only. A point that is given besides, that of the last pixel, is not read.
int picked(const PointCloud& cloud, int row, int column) {
  NearPoint::Settings s = near_point({0.3, 0.2, 1}, 0.05);
  s.row = row, s.column = column;
  const Column weights = NearPoint(s).weights(cloud);
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

TEST(NearPoint, AHolePicksTheNearestPixelThatSawSomething) {
  EXPECT_EQ(picked(wall({{2, 1}, {1, 1}, {2, 0}, {2, 2}}), 1, 2), 6 * 1 + 3);
  EXPECT_EQ(picked(wall({{2, 1}, {1, 1}, {3, 1}, {2, 2}}), 1, 2), 6 * 0 + 2);
  EXPECT_EQ(picked(wall({{2, 1}, {1, 1}, {3, 1}, {2, 0}}), 1, 2), 6 * 2 + 2);
  // A diagonal neighbour is nearer than the second one in the row.
  EXPECT_EQ(picked(wall({{2, 1}, {1, 1}, {3, 1}, {2, 0}, {2, 2}, {1, 0}, {3, 0}, {1, 2}}), 1, 2), 6 * 2 + 3);
  EXPECT_EQ(picked(wall({{0, 0}}), 0, 0) % 5, 1);  // one of its two neighbours, 1 and 6
  PointCloud holes = wall();
  holes.x.assign(holes.size(), kNaN), holes.y = holes.x, holes.z = holes.x;
  EXPECT_EQ(picked(holes, 1, 1), -1);
}

// --- shares of colours ---

constexpr std::uint32_t kRed = 0xFF0000, kYellow = 0xFFFF00, kGreen = 0x00FF00, kCyan = 0x00FFFF,
                        kBlue = 0x0000FF, kPurple = 0xFF00FF;

HueRange::Settings hues(double from_deg, double to_deg, double min_saturation = 0.3,
                        double min_lightness = 0.1, double max_lightness = 0.9) {
  return {{}, from_deg, to_deg, min_saturation, min_lightness, max_lightness};
}

// A missing colour would be black if it counted as a colour.
TEST(HueRange, PicksHuesThatAreNeitherGreyNorDarkNorLight) {
  const std::vector<std::uint32_t> sixths{kRed, kYellow, kGreen, kCyan, kBlue, kPurple};
  const struct {
    const char* what;
    HueRange::Settings settings;
    std::vector<std::uint32_t> colours;
    Column expected;
  } cases[] = {{"both ends belong to it", hues(60, 180), sixths, {0, 1, 1, 1, 0, 0}},
               {"nothing beyond its ends", hues(60.001, 179.999), sixths, {0, 0, 1, 0, 0, 0}},
               {"one hue", hues(120, 120), sixths, {0, 0, 1, 0, 0, 0}},
               {"the circle", hues(0, 360), sixths, {1, 1, 1, 1, 1, 1}},
               {"through zero", hues(300, 60), sixths, {1, 1, 0, 0, 0, 1}},
               {"through zero, without the ends", hues(300.001, 59.999), sixths, {1, 0, 0, 0, 0, 0}},
               {"the circle and more", hues(180, 120), sixths, {1, 1, 1, 1, 1, 1}},
               {"the default", {}, {kRed, 0xFF2000, 0xFF0020, kYellow, kPurple}, {1, 1, 1, 0, 0}},
               {"saturation 0, 51/255, 50/256", hues(0, 360, 0.2), {0x7F7F7F, 0x996666, 0x996767}, {0, 1, 0}},
               {"greys", hues(0, 360, 0), {0x7F7F7F, 0x996666}, {1, 1}},
               {"lightness 102 and 408 of 510",
                hues(0, 360, 0.3, 0.2, 0.8),
                {0x660000, 0x650000, 0xFF9999, 0xFF9A9A, kRed},
                {1, 0, 1, 0, 1}},
               {"one lightness", hues(0, 360, 0.3, 0.2, 0.2), {0x660000, kRed}, {1, 0}},
               {"no colour", hues(0, 360, 0, 0), {0x000000, kNoColour, kRed}, {1, 0, 1}},
               {"no point", {}, {}, {}}};
  for (const auto& c : cases) {
    PointCloud cloud = cloud_of(std::vector<Vec3>(c.colours.size(), Vec3::Zero()));
    cloud.colour = c.colours;
    EXPECT_EQ(HueRange(c.settings).weights(cloud), c.expected) << c.what;
  }
  PointCloud missing = cloud_of({kMissing, {0, 0, 0}});
  missing.colour = {kRed, kRed};
  EXPECT_EQ(HueRange({}).weights(missing), (Column{0, 1}));
}

// --- refusals ---

FixtureValues scheduled(Column rows) {
  FixtureValues values{0.02};
  values.schedule = std::move(rows);
  return values;
}

TEST(FixtureRules, RefuseWhatTheyCannotUse) {
  NearPoint::Settings half;
  half.row = 0;
  const std::pair<std::string, std::string> cases[] = {
      {validate(half_space({0, 0, 0}, {0, 0, 0})), "normal: expected longer than 0"},
      {validate(half), "row and column: expected both 0 or more, or both -1"},
      {refusal([] { picked(wall(), 4, 0); }), "near-point: row, column: expected below 4 and 6"},
      {refusal([] { picked(wall(), 0, 6); }), "near-point: row, column: expected below 4 and 6"},
      {refusal([] { picked(wall(), 3, 5); }), "no InputError"},
      {refusal([] {
         picked(cloud_of({{0, 0, 0}}), 0, 0);
       }),
       "the frame is not an image"},
      {validate(hues(0, 360, 0.3, 0.3, 0.2)), "min_lightness = 0.3"},
      {refusal([] {
         HueRange({}).weights(cloud_of({{0, 0, 0}}));
       }),
       "the frame has no colours"},
      {validate(FixtureValues{-0.5}), "radius_m = -0.500000: expected 0 or more, or -1"},
      {validate(FixtureValues{0, -0.5}), "stiffness_N_per_m = -0.500000: expected 0 or more, or -1"},
      {validate(scheduled({0, 0, 1, 1.5})), "schedule: strength 1.500000: expected 0 to 1"},
      {validate(scheduled({0, 0, 2, 1, 1, 0})),
       "schedule: time 1.000000: expected no earlier than the row before"}};
  for (const auto& [said, expected] : cases) EXPECT_HAS(said, expected);
  for (const FixtureValues& values : {FixtureValues{}, {0, 0}, scheduled({0, 0, 0, 1, 3, 0.5})})
    EXPECT_EQ(validate(values), "");
  EXPECT_EQ(validate(HalfSpace::Settings{}) + validate(NearPoint::Settings{}) + validate(hues(0, 9)), "");
}

// --- successive rules ---

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
  FixtureValues values;
  Column weights;
};

FixtureAssignment assignment(const std::vector<Rule>& rules, double own_N_per_m = kNaN) {
  std::vector<std::unique_ptr<const FixtureRule>> list;
  for (const Rule& rule : rules) list.push_back(std::make_unique<GivenWeights>(rule.values, rule.weights));
  return FixtureAssignment(std::move(list), nullptr, own_N_per_m);
}

PointCloud points(std::size_t count) {
  return scenes::cloud_of(std::vector<Vec3>(count, Vec3::Zero()));
}

PointCloud assigned(const std::vector<Rule>& rules, PointCloud cloud, double captured_s = 0) {
  assignment(rules).assign(cloud, captured_s);
  return cloud;
}

struct Columns {
  Column radius_m, stiffness_N_per_m;
};

// If the renderer's own stiffness is not known, a half of it cannot be blended in: a point without a
// stiffness, NaN, takes that of a rule at once.
TEST(FixtureAssignment, LaterRulesBlendIntoWhatEarlierRulesOrTheCloudHave) {
  const Rule first{{0.02, 100}, {1, 1, 0, 0}}, second{{0.05, 300}, {0, 1, 1, 0}};
  const Columns own{{0.1, 0.2, 0.3}, {10, 20, 30}};
  const struct {
    const char* what;
    std::vector<Rule> rules;
    Columns start, expected;
  } cases[] = {
      {"no rules", {}, {}, {}},
      {"no rules, and columns of the cloud", {}, own, own},
      {"points that no rule picks", {{{0.02}, {0, 1, 0}}}, {}, {{0, 0.02, 0}, {}}},
      {"no point is picked", {{{0.02}, {0, 0, 0}}}, {}, {{0, 0, 0}, {}}},
      {"columns of the cloud", {{{0.5, 40}, {0, 0.5, 1}}}, own, {{0.1, 0.35, 0.5}, {10, 30, 40}}},
      {"no rule names a stiffness", {{{0.02}, {1, 1}}, {{0.01}, {1, 0}}}, {}, {{0.01, 0.02}, {}}},
      {"the cloud's stiffness stays", {{{0.02}, {1, 1}}}, {{}, {5, 6}}, {{0.02, 0.02}, {5, 6}}},
      {"that of the rule before stays", {{{0.02, 100}, {1}}, {{0.03}, {1}}}, {}, {{0.03}, {100}}},
      {"a later rule overrides", {first, second}, {}, {{0.02, 0.05, 0.05, 0}, {100, 300, 300, kNaN}}},
      {"in the other order", {second, first}, {}, {{0.02, 0.02, 0.05, 0}, {100, 100, 300, kNaN}}},
      {"a later rule removes a region", {{{0.02}, {1, 1}}, {{0}, {1, 0}}}, {}, {{0, 0.02}, {}}},
      {"or leaves the radius", {{{0.02}, {1, 0}}, {{-1, 300}, {1, 1}}}, {}, {{0.02, 0}, {300, 300}}},
      {"a share moves the value of earlier rules",
       {{{0.04}, {0.25, 0.5, 1}}, {{0.1}, {0.5, 0, 0.1}}},
       {},
       {{0.055, 0.02, 0.046}, {}}},
      {"a value is reached exactly", {{{0.1, 0.3}, {1}}}, {{0.7}, {1e4}}, {{0.1}, {0.3}}},
      {"no stiffness to begin with", {{{-1, 100}, {0, 0.25, 1}}}, {}, {{0, 0, 0}, {kNaN, 100, 100}}},
      {"then it is blended", {{{-1, 100}, {0.25}}, {{-1, 200}, {0.25}}}, {}, {{0}, {125}}},
      {"0 is a stiffness, too", {{{-1, 0}, {1}}, {{-1, 200}, {0.25}}}, {}, {{0}, {50}}}};
  for (const auto& c : cases) {
    SCOPED_TRACE(c.what);
    const std::size_t count = std::max(c.expected.radius_m.size(), c.expected.stiffness_N_per_m.size());
    PointCloud cloud = points(count);
    cloud.fixture_radius_m = c.start.radius_m, cloud.stiffness_N_per_m = c.start.stiffness_N_per_m;
    cloud = assigned(c.rules, cloud);
    expect_near(cloud.fixture_radius_m, c.expected.radius_m, 1e-15);
    expect_near(cloud.stiffness_N_per_m, c.expected.stiffness_N_per_m, 1e-15);
  }
  EXPECT_TRUE(assignment({}).empty() && FixtureAssignment().empty());
  EXPECT_FALSE(assignment({first}).empty());
}

// A rule fades in from the renderer's own stiffness, on the CPU and in the steps for an OpenCL device.
TEST(FixtureAssignment, AStiffnessFadesInFromTheRenderersOwn) {
  PointCloud cloud = points(4);
  assignment({{{0.02, 100}, {0, 1e-9, 0.25, 1}}}, 300).assign(cloud, 0);
  expect_near(cloud.stiffness_N_per_m, {kNaN, 300, 250, 100}, 1e-6);
  HueRange::Settings hue;
  hue.values.stiffness_N_per_m = 100;
  std::vector<std::unique_ptr<const FixtureRule>> rules;
  rules.push_back(std::make_unique<HueRange>(hue));
  EXPECT_EQ(
      FixtureAssignment(std::move(rules), nullptr, 300).hue_steps(0, 0).value()[0].first_stiffness_N_per_m,
      300);
}

// --- strength over time ---

TEST(Schedule, IsEvenBetweenRowsConstantOutsideAndJumpsWhereTwoRowsHaveTheSameTime) {
  const Column rows{1, 0.25, 3, 0.75, 4, 0}, jumps{1, 0, 2, 0.5, 2, 1, 2, 0.25, 3, 0.75}, begins{0, 1, 0, 0};
  const struct {
    Column rows;
    double time_s, expected;
  } cases[] = {{rows, -5, 0.25},
               {rows, 0, 0.25},
               {rows, 1, 0.25},
               {rows, 1.5, 0.375},
               {rows, 2, 0.5},
               {rows, 3, 0.75},
               {rows, 3.5, 0.375},
               {rows, 4, 0},
               {rows, 4.001, 0},
               {rows, 1e6, 0},
               {{}, -1, 1},
               {{}, 1e6, 1},
               {{2, 0.5}, 0, 0.5},
               {{2, 0.5}, 1e6, 0.5},
               {jumps, 2, 0.25},
               {jumps, 2.5, 0.5},
               {begins, 0, 0},
               {begins, -1e-9, 1},
               {jumps, std::nextafter(2, 0), 0.5}};
  for (const auto& c : cases)
    EXPECT_NEAR(Everywhere({scheduled(c.rows)}).strength(c.time_s), c.expected, 1e-12) << c.time_s;
}

// A rule of zero strength does not give a stiffness either.
TEST(Schedule, MultipliesTheShare) {
  FixtureValues values = scheduled({0, 0, 2, 1});
  values.stiffness_N_per_m = 50;
  const Rule rule{values, {1, 0.5}};
  const std::pair<double, Columns> cases[] = {
      {0, {{0, 0}, {kNaN, kNaN}}}, {0.5, {{0.005, 0.0025}, {50, 50}}}, {7, {{0.02, 0.01}, {50, 50}}}};
  for (const auto& [time_s, expected] : cases) {
    const PointCloud cloud = assigned({rule}, points(2), time_s);
    expect_near(cloud.fixture_radius_m, expected.radius_m, 1e-15);
    expect_near(cloud.stiffness_N_per_m, expected.stiffness_N_per_m, 0);
  }
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

TEST(FixtureAssignment, StepsByHueAreItsRulesThatAreOnWithTheirStrengthThen) {
  const FixtureAssignment fixtures = by_hue(FixtureRole::forbidden, false);
  const HueSteps steps = fixtures.hue_steps(0.5, 0).value();
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_EQ(steps[0].range.from_deg, 340);
  EXPECT_EQ(steps[0].strength, 1);
  EXPECT_EQ(steps[1].range.values.radius_m, 0.03);
  EXPECT_EQ(steps[1].strength, 0.25);
  const HueSteps blue = fixtures.hue_steps(2, 1).value();
  ASSERT_EQ(blue.size(), 1u);
  EXPECT_EQ(blue[0].range.from_deg, 200);
  EXPECT_EQ(fixtures.hue_steps(2, 3).value().size(), 0u);  // the column of r_f is still made
  EXPECT_FALSE(by_hue(FixtureRole::guidance, false).hue_steps(0, 0).has_value());
  EXPECT_FALSE(by_hue(FixtureRole::forbidden, true).hue_steps(0, 0).has_value());
  EXPECT_FALSE(FixtureAssignment().hue_steps(0, 0).has_value());
}

}  // namespace
}  // namespace remote_touch::fixture_rules_test
