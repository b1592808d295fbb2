// Combination of successive rules: order, blending, strength over time, and the columns of r_f and k_s.
#include "core/dissertation/virtual_fixtures/fixture_assignment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "tests/support/test_files.h"

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

// --- columns ---

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

// --- order and blending ---

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

// --- strength over time ---

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

TEST(Schedule, StrengthIsAlwaysOneIfThereAreNoRows) {
  for (const double time_s : {-1.0, 0.0, 1e6}) EXPECT_EQ(strength({}, time_s), 1);
}

TEST(Schedule, StrengthIsConstantIfThereIsOneRow) {
  for (const double time_s : {-1.0, 2.0, 1e6}) EXPECT_EQ(strength({2, 0.5}, time_s), 0.5);
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

// --- what is refused ---

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

// --- steps by hue, for another device ---

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
