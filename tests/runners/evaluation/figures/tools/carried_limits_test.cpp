#include "runners/evaluation/figures/tools/carried_limits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
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

}  // namespace
}  // namespace remote_touch::carried_limits_test
