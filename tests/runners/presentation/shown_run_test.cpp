#include "runners/presentation/result_pages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "runners/experiment/catalog/experiment.h"
#include "tests/support/scenes.h"

namespace remote_touch::true_heights_test {
namespace {

constexpr int n = TrueHeights::kColumns;

// An inclined plane that rises and is known for x >= 0 only.
class RisingPlane final : public Scenario {
 public:
  explicit RisingPlane(double velocity_m_per_s) : velocity_(velocity_m_per_s) {}
  double frame_rate_hz() const override { return 30; }
  int frame_count() const override { return 1; }
  std::shared_ptr<const NeighbourSearch> points(int) const override { return nullptr; }
  PointCloud cloud(int) const override { return {}; }
  double signed_distance(const Vec3&, double) const override { return 0; }
  double surface_height(double x, double z, double time_s) const override {
    return x < -1e-9 ? std::nan("") : 0.5 * x - 0.25 * z + velocity_ * time_s;
  }

 private:
  double velocity_;
};

const BoundingBox kBox(Vec3(-0.1, -1, -0.2), Vec3(0.1, 1, 0.2));

std::vector<double> ticks(double from_s, double to_s) {
  std::vector<double> list;
  for (int i = 0; from_s + 0.001 * i <= to_s + 1e-9; ++i) list.push_back(from_s + 0.001 * i);
  return list;
}

TEST(TrueHeights, AreThoseOfTheSceneOverItsGridAndTimes) {
  const RisingPlane scene(0.3);
  const TrueHeights all = true_heights(scene, kBox, ticks(1, 3));
  ASSERT_EQ(all.height_m.size(), all.time_s.size() * n * n);
  EXPECT_FALSE(all.stays);
  EXPECT_EQ(all.time_s.front(), 1);
  EXPECT_EQ(all.time_s.back(), 3);
  ASSERT_GT(all.time_s.size(), 60u);
  ASSERT_LE(all.time_s.size(), 200u);
  for (std::size_t t = 0; t < all.time_s.size(); t += 7)
    for (int k = 0; k < n; k += 5)
      for (int i = 0; i < n; i += 4) {
        const double x = -0.1 + 0.2 * i / (n - 1), z = -0.2 + 0.4 * k / (n - 1);
        const double height =
            all.height_m[(t * n + static_cast<std::size_t>(k)) * n + static_cast<std::size_t>(i)];
        if (x < -1e-9)
          EXPECT_TRUE(std::isnan(height));
        else
          EXPECT_NEAR(height, 0.5 * x - 0.25 * z + 0.3 * all.time_s[t], 1e-6);
      }
}

TEST(TrueHeights, OneTimeIsEnoughForASceneAtRest) {
  const TrueHeights all = true_heights(RisingPlane(0), kBox, ticks(0, 3));
  EXPECT_EQ(all.time_s.size(), 1u);
  EXPECT_EQ(all.height_m.size(), std::size_t{n * n});
}

TEST(TrueHeights, AreMissingIfTheSurfaceIsUnknown) {
  const BoundingBox left(Vec3(-0.3, -1, -0.2), Vec3(-0.1, 1, 0.2));
  EXPECT_TRUE(true_heights(RisingPlane(0.1), left, ticks(0, 3)).empty());
}

// The height that the page draws at a time, over the node in the middle.
double drawn_m(const TrueHeights& all, double time_s) {
  const auto height = [&](std::size_t t) {
    return static_cast<double>(all.height_m[(t * n + n / 2) * n + n / 2]);
  };
  std::size_t i = 0;
  while (i + 1 < all.time_s.size() && all.time_s[i + 1] <= time_s) ++i;
  if (all.stays || i + 1 == all.time_s.size()) return height(i);
  return std::lerp(height(i), height(i + 1), (time_s - all.time_s[i]) / (all.time_s[i + 1] - all.time_s[i]));
}

// The column signed_distance is 0 on the sheet that is drawn, or both are unknown. This holds in every tick
// if the sheet stays between captures, and at the stored times if it moves evenly between them.
void expect_the_truth_of_the_column(const std::string& name, const std::vector<std::string>& settings,
                                    bool stays) {
  SCOPED_TRACE(name + (settings.empty() ? "" : " " + settings.back()));
  const Experiment experiment = Experiment::load(name, settings);
  const auto scenario = experiment.build_scenario(scenes::kernels());
  const std::vector<double> times = ticks(0, 1.5);
  const BoundingBox box(Vec3(-0.01, -0.1, -0.01), Vec3(0.01, 0.1, 0.01));
  const TrueHeights all = true_heights(*scenario, box, times);
  ASSERT_FALSE(all.empty());
  EXPECT_EQ(all.stays, stays);
  EXPECT_GE(all.time_s.size(), 2u) << "it moves";
  for (const double t : stays ? times : all.time_s) {
    const double y = drawn_m(all, t), distance_m = scenario->signed_distance({0, y, 0}, t);
    if (std::isnan(scenario->signed_distance(Vec3::Zero(), t)))
      EXPECT_TRUE(std::isnan(y)) << t;
    else
      ASSERT_NEAR(distance_m, 0, 1e-6) << t;
  }
}

TEST(TrueHeights, AreThoseFromWhichTheColumnMeasures) {
  expect_the_truth_of_the_column("fig4.12", {}, true);
  expect_the_truth_of_the_column("fig4.12", {"scenario.truth=moving"}, false);
  expect_the_truth_of_the_column("parallel-sheets", {}, true);
  expect_the_truth_of_the_column("vanishing-plane", {}, true);
  expect_the_truth_of_the_column("sliding-ridge", {}, false);
}

// A sine of 10 mm and 1 Hz for 40 s: 200 even times are off by 10 mm.
TEST(TrueHeights, ALongMotionIsAsAccurateAsAShortOne) {
  const Experiment experiment = Experiment::from_json(
      R"({"scenario": {"name": "moving-shape", "shape": "flat", "shake_amplitude_m": 0.01, "shake_hz": 1,
                       "truth": "moving"},
          "renderer": {"name": "proxy"}, "trajectory": {"name": "press"}, "duration_s": 40})",
      "test");
  const auto scenario = experiment.build_scenario(scenes::kernels());
  const TrueHeights all =
      true_heights(*scenario, BoundingBox(Vec3(-0.01, -0.1, -0.01), Vec3(0.01, 0.1, 0.01)), ticks(0, 40));
  EXPECT_LE(all.time_s.size(), 600u);
  double worst_m = 0;
  for (double t = 0; t < 40; t += 0.0037)
    worst_m = std::max(worst_m, std::abs(drawn_m(all, t) - scenario->surface_height(0, 0, t)));
  EXPECT_LT(worst_m, 1.5 * all.error_m);
  EXPECT_LT(all.error_m, 4e-4);
}

TEST(TrueHeights, StateTheErrorBetweenTheirNodes) {
  EXPECT_NEAR(true_heights(RisingPlane(0.3), kBox, ticks(1, 3)).error_m, 0, 1e-6);
  const auto scenario = Experiment::load("fig4.14").build_scenario(scenes::kernels());
  const BoundingBox wide(Vec3(-0.2, -0.1, -0.05), Vec3(0.2, 0.1, 0.05));  // nodes are 10 mm apart
  const TrueHeights all = true_heights(*scenario, wide, ticks(0, 1));
  EXPECT_GT(all.error_m, 0.001);
  EXPECT_LT(all.error_m, 0.01);
}

}  // namespace
}  // namespace remote_touch::true_heights_test
