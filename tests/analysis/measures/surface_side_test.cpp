// Pop-through: from the front of the true surface to its back.
#include "analysis/measures/surface_side.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace remote_touch::surface_side_test {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

double popped_through(const std::vector<double>& distance_m, double held_depth_m = 0) {
  SurfaceSide side(held_depth_m);
  for (const double each_m : distance_m) side.add(each_m);
  return side.popped_through();
}

std::vector<std::size_t> crossings(const std::vector<double>& distance_m, double held_depth_m = 0) {
  SurfaceSide side(held_depth_m);
  std::vector<std::size_t> ticks;
  for (std::size_t i = 0; i < distance_m.size(); ++i)
    if (side.add(distance_m[i])) ticks.push_back(i);
  return ticks;
}

TEST(SurfaceSide, CrossesFromTheFrontToTheBack) {
  EXPECT_EQ(popped_through({0.01, 0, -1e-9}), 1);
  EXPECT_EQ(popped_through({0.01, -0.01, 0.01}), 0) << "it came back";
  EXPECT_EQ(popped_through({0.01, 0.005}), 0);
  EXPECT_EQ(crossings({0.1, 0, -0.1, -0.2, 0.1, -0.1}), (std::vector<std::size_t>{2, 5}));
}

TEST(SurfaceSide, AProxyThatBeginsBehindHasNotPoppedThrough) {
  EXPECT_EQ(popped_through({-0.03, -0.002, -0.03}), 0);
  EXPECT_TRUE(crossings({-0.03, -0.002, -0.03}).empty());
  EXPECT_EQ(popped_through({-0.03, 0.002, -0.03}), 1) << "it was in front in between";
}

TEST(SurfaceSide, APositionOnTheSurfaceIsHeldUpToADepth) {
  EXPECT_EQ(popped_through({0.01, -2.37e-16}, 0.0025), 0);
  EXPECT_EQ(popped_through({0.01, -0.0025}, 0.0025), 0);
  EXPECT_EQ(popped_through({0.01, -0.001, -0.0026}, 0.0025), 1);
  EXPECT_EQ(crossings({0.01, -0.001, 0.001, -0.003}, 0.0025), std::vector<std::size_t>{3});
}

TEST(SurfaceSide, ResultIsNanIfTheWayToTheBackIsUnknown) {
  EXPECT_TRUE(std::isnan(popped_through({})));
  EXPECT_TRUE(std::isnan(popped_through({0.01, -0.01, kUnknown})));
  EXPECT_TRUE(std::isnan(popped_through({0.01, kUnknown, -0.01}))) << "round the border";
  EXPECT_TRUE(std::isnan(popped_through({kUnknown, -0.01})));
  EXPECT_TRUE(crossings({0.01, kUnknown, -0.01}).empty());
  EXPECT_EQ(popped_through({kUnknown, 0.01, -0.01}), 1);
  EXPECT_EQ(popped_through({0.01, -0.01, kUnknown, -0.01}), 1) << "it had crossed before";
  EXPECT_EQ(popped_through({-0.01, kUnknown, -0.01}), 0);
  EXPECT_EQ(popped_through({0.01, kUnknown, 0.01}), 0);
}

}  // namespace
}  // namespace remote_touch::surface_side_test
