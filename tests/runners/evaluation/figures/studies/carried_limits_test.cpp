#include "runners/evaluation/figures/studies/carried_limits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <string>
#include <vector>

namespace remote_touch::carried_limits_test {
namespace {

// A sweep of one setting; lost: whether the tool is lost at each strength, the same for every rule.
CarrySweep sweep_of(const std::vector<double>& strengths, const std::vector<double>& lost) {
  SweepResult result;
  result.axes = {{"strength", "m/s", "", strengths, 1, {}},
                 {"rule", "1", "", std::vector<double>{0, 1, 2}, 1, {}}};
  std::vector<double> popped;
  for (const double at_strength : lost) popped.insert(popped.end(), std::size(kCarriers), at_strength);
  result.measures = {{"tool_popped_through", "1", "", popped, 1, {}}};
  result.state.assign(result.run_count(), RunState::done);
  return CarrySweep(result);
}

TEST(CarrySweep, CarriesUpToTheStrengthBelowTheFirstThatIsLost) {
  const CarrySweep::Limit limit = sweep_of({0, 1, 2}, {0, 1, 1}).limit(0, Carrier::look_ahead);
  EXPECT_EQ(limit.carried, 0);
  EXPECT_EQ(limit.lost, 1);
  EXPECT_EQ(limit.all_lost, 1);
}

TEST(CarrySweep, CarriesUpToNoStrengthIfTheFirstIsLost) {
  const CarrySweep::Limit limit = sweep_of({1, 2}, {1, 0}).limit(0, Carrier::voxels);
  EXPECT_TRUE(std::isnan(limit.carried));
  EXPECT_EQ(limit.lost, 1);
  EXPECT_TRUE(std::isinf(limit.all_lost));
}

TEST(CountRowsApart, CountsNoRowApartIfNothingIsCarriedAboveTheBound) {
  Table table{"limits", ""};
  table.add("carried", "m/s", "", {std::nan(""), 2, 3});
  table.add("lost", "m/s", "", {1, 3, 4});
  table.add("low", "m/s", "", {1, 1, 1});
  table.add("high", "m/s", "", {2, 2, 2});
  EXPECT_EQ(count_rows_apart(table, "carried", "lost", "low", "high"), 1);
}

TEST(CountRowsApart, CountsARowWithoutABoundAsApart) {
  Table table{"limits", ""};
  table.add("carried", "m/s", "", {1, 1});
  table.add("lost", "m/s", "", {2, 2});
  table.add("low", "m/s", "", {std::nan(""), 1});
  table.add("high", "m/s", "", {2, std::nan("")});
  EXPECT_EQ(count_rows_apart(table, "carried", "lost", "low", "high"), 2);
}

TEST(DerivedTable, HasEvenlySpacedSettingsFromTheFirstToTheLast) {
  Table limits{"limits", "Limits"};
  limits.add("thickness", "m", "", {1, 2, 5});
  limits.add("voxels_carried", "m/s", "", {1, 2, 3});
  const Table derived = derived_table(
      limits, [](Carrier rule, double setting) { return rule == Carrier::voxels ? 2 * setting : setting; },
      5);
  EXPECT_EQ(derived.name, "limits_bounds");
  EXPECT_EQ(numbers(derived, "thickness"), (std::vector<double>{1, 2, 3, 4, 5}));
  EXPECT_EQ(numbers(derived, "voxels_bound"), (std::vector<double>{2, 4, 6, 8, 10}));
  EXPECT_EQ(numbers(derived, "continuous_bound"), (std::vector<double>{1, 2, 3, 4, 5}));
  EXPECT_EQ(derived.columns[1].units, "m/s");
}

TEST(AddLimitPanel, DrawsABarFromTheLastCarriedToTheFirstLostStrengthOfEachRule) {
  Table limits{"limits", "Limits"};
  limits.add("thickness", "m", "", {1, 2});
  for (const CarrierName& carrier : kCarriers)
    for (const char* what : {"_carried", "_first_lost"})
      limits.add(carrier.column + std::string(what), "m/s", "", {1, 2});
  Figure figure;
  add_limit_panel(figure, limits, [](Carrier, double) { return 1.0; }, {"thickness (m)", "speed (m/s)"}, {});
  ASSERT_EQ(figure.panels.size(), 1U);
  const std::vector<Curve>& curves = figure.panels[0].curves;
  ASSERT_EQ(curves.size(), 3 * std::size(kCarriers));
  EXPECT_EQ(curves[0].table, "limits_bounds");
  EXPECT_EQ(curves[1].style, CurveStyle::intervals);
  EXPECT_EQ(curves[1].y, "voxels_carried");
  EXPECT_EQ(curves[1].z, "voxels_first_lost");
  EXPECT_EQ(curves[2].label, "as printed") << "the bar takes the colour of the curve after it";
}

}  // namespace
}  // namespace remote_touch::carried_limits_test
