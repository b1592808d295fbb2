// What a page shows of a run: the true heights of its scene, and the points that are shown or touched.
#include "runners/presentation/result_pages.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <limits>

#include "runners/experiment/catalog/experiment.h"
#include "tests/support/box_tool.h"
#include "tests/support/scenes.h"

namespace remote_touch::shown_run_test {
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

TEST(TrueHeights, AreOneTimeAtRestAndNoneIfTheSurfaceIsUnknown) {
  const TrueHeights at_rest = true_heights(RisingPlane(0), kBox, ticks(0, 3));
  EXPECT_EQ(at_rest.time_s.size(), 1u);
  EXPECT_EQ(at_rest.height_m.size(), std::size_t{n * n});
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

// --- points ---

const BoundingBox kNearBox(Vec3(-0.03, -0.03, -0.03), Vec3(0.03, 0.03, 0.03));
const std::vector<Vec3> kPath{{0, 0, 0}, {0.001, 0, 0}, {0.02, 0.01, 0}};

PointCloud cloud_with_holes() {
  PointCloud cloud = scenes::random_cloud(20000, 0.05, 4);
  for (std::size_t i = 0; i < cloud.size(); i += 50) cloud.y[i] = std::numeric_limits<double>::quiet_NaN();
  return cloud;
}

bool is_shown(const ShownPoints& shown, std::size_t i) {
  return std::binary_search(shown.indices.begin(), shown.indices.end(), i);
}

TEST(ShownPoints, AreAllPointsInTheBoxIfTheyAreFewEnough) {
  const PointCloud cloud = cloud_with_holes();
  const ShownPoints shown = shown_points(cloud, {}, kPath, {kNearBox, 0.005, cloud.size()});
  std::size_t measured = 0, in_box = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const bool inside = cloud.is_measured(i) && kNearBox.contains(cloud.point(i));
    measured += cloud.is_measured(i), in_box += inside;
    EXPECT_EQ(is_shown(shown, i), inside) << i;
  }
  EXPECT_EQ(shown.measured, measured);
  EXPECT_EQ(shown.in_box, in_box);
  EXPECT_EQ(shown.indices.size(), in_box);
}

TEST(ShownPoints, AreAllNearTheProxyAndAboutAsManyOthersAsAllowed) {
  const PointCloud cloud = cloud_with_holes();
  const ShownPoints shown = shown_points(cloud, {}, kPath, {kNearBox, 0.005, 500});
  std::size_t near = 0, others = 0, others_shown = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_measured(i) || !kNearBox.contains(cloud.point(i))) continue;
    double from_path_m = 1;
    for (const Vec3& proxy : kPath) from_path_m = std::min(from_path_m, (cloud.point(i) - proxy).norm());
    if (from_path_m <= 0.005) {
      EXPECT_TRUE(is_shown(shown, i)) << i;
      ++near;
    } else if (from_path_m > 1.1 * 0.005) {  // both are right in between
      ++others, others_shown += is_shown(shown, i);
    }
  }
  ASSERT_GT(near, 20u);
  // The number is that of a draw with the same chance for each of the others, within four standard
  // deviations.
  const double chance = 500 / static_cast<double>(others);
  EXPECT_NEAR(static_cast<double>(others_shown), 500, 4 * std::sqrt(500 * (1 - chance)));
}

TEST(ShownPoints, RequestedPointsAreShownOutsideOfTheBoxToo) {
  const PointCloud cloud = cloud_with_holes();
  std::vector<std::uint32_t> always;
  for (std::uint32_t i = 1; i < 40; i += 2) always.push_back(i);
  const ShownPoints shown = shown_points(cloud, always, {}, {kNearBox, 0, 0});
  EXPECT_EQ(shown.indices, always);
}

TEST(ShownPoints, FewerAreThoseOfTheSmallestRanks) {
  const PointCloud cloud = cloud_with_holes();
  const std::vector<std::uint32_t> always{5, 7, 1001};
  const ShownPoints many = shown_points(cloud, always, kPath, {kNearBox, 0.005, 900});
  const ShownPoints few = shown_points(cloud, always, kPath, {kNearBox, 0.005, 100});
  ASSERT_EQ(many.rank.size(), many.indices.size());
  EXPECT_EQ(many.others, few.others);
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < many.indices.size(); ++i)
    if (many.rank[i] < rank_limit(many.others, 100)) kept.push_back(many.indices[i]);
  EXPECT_EQ(kept, few.indices);
  EXPECT_LT(kept.size(), many.indices.size());
  for (const std::uint32_t i : always) EXPECT_TRUE(is_shown(few, i));
}

// A point that is left out of one frame is left out of the next, so that an animation does not flicker.
TEST(ShownPoints, AreTheSamePixelsInEveryFrame) {
  PointCloud cloud = cloud_with_holes();
  const ShownPointsRule rule{kNearBox, 0, 300};
  const std::vector<std::uint32_t> before = shown_points(cloud, {}, {}, rule).indices;
  for (double& y : cloud.y) y += 1e-6;
  std::vector<std::uint32_t> common;
  const std::vector<std::uint32_t> after = shown_points(cloud, {}, {}, rule).indices;
  std::set_intersection(before.begin(), before.end(), after.begin(), after.end(), std::back_inserter(common));
  EXPECT_GT(static_cast<double>(common.size()), 0.98 * static_cast<double>(before.size()));
}

TEST(TouchingProxy, AreThoseOfEveryPointAskedInEveryTick) {
  PointCloud cloud = scenes::random_cloud(20000, 0.03, 6);
  for (std::size_t i = 0; i < cloud.size(); ++i) cloud.fixture_radius_m.push_back(i % 3 == 0 ? 0.002 : 0);
  cloud.z[5] = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Vec3> path{
      {0, 0, 0}, {0.004, 0.001, 0}, Vec3::Constant(std::numeric_limits<double>::quiet_NaN())};
  const TouchingPoints touching = touching_proxy(path, 0.005, cloud);
  ASSERT_EQ(touching.size(), 3u);
  for (std::size_t tick = 0; tick < 2; ++tick) {
    std::vector<std::uint32_t> expected;
    for (std::size_t i = 0; i < cloud.size(); ++i)
      if ((cloud.point(i) - path[tick]).norm() - cloud.fixture_radius_m[i] <= 0.005)
        expected.push_back(static_cast<std::uint32_t>(i));
    EXPECT_EQ(touching[tick], expected) << tick;
    EXPECT_GT(expected.size(), 20u);
  }
  EXPECT_TRUE(touching[2].empty());
}

// A box that slides and turns through a random cloud.
std::vector<ToolPose> poses() {
  std::vector<ToolPose> list;
  for (int i = 0; i < 30; ++i)
    list.push_back({Vec3(0.0008 * i - 0.01, 0.002, 1e-4 * i),
                    Eigen::Quaterniond(Eigen::AngleAxisd(0.03 * i, Vec3(1, 2, 3).normalized()))});
  return list;
}

TEST(TouchingTool, AreThoseOfEveryPointAskedInEveryTick) {
  const auto tool = scenes::box_tool({0.02, 0.005, 0.01});
  const PointCloud cloud = scenes::random_cloud(20000, 0.05, 6);
  const std::vector<ToolPose> path = poses();
  const auto touching = touching_tool(*tool, path, cloud);
  ASSERT_EQ(touching.size(), path.size());
  for (std::size_t tick = 0; tick < path.size(); ++tick) {
    std::vector<std::uint32_t> expected;
    for (std::size_t i = 0; i < cloud.size(); ++i)
      if (sample_field(*tool, path[tick].q_WT.conjugate() * (cloud.point(i) - path[tick].p_W)).distance_m <=
          kTouchingTool_m)
        expected.push_back(static_cast<std::uint32_t>(i));
    EXPECT_EQ(touching[tick], expected) << tick;
    EXPECT_GT(expected.size(), 20u);
  }
}

TEST(TouchingTool, NoPointTouchesIfThereIsNoPose) {
  const auto tool = scenes::box_tool({0.02, 0.005, 0.01});
  const PointCloud cloud = scenes::random_cloud(2000, 0.02, 6);
  std::vector<ToolPose> path(3);
  path[1].p_W.x() = std::numeric_limits<double>::quiet_NaN();
  const auto touching = touching_tool(*tool, path, cloud);
  EXPECT_FALSE(touching[0].empty());
  EXPECT_TRUE(touching[1].empty());
  EXPECT_EQ(touching[2], touching[0]);
  path[2].p_W = path[1].p_W;
  EXPECT_EQ(touching_tool(*tool, path, cloud)[0], touching[0]) << "the only pose is before the middle";
  for (ToolPose& pose : path) pose.p_W.x() = std::numeric_limits<double>::quiet_NaN();
  for (const auto& none : touching_tool(*tool, path, cloud)) EXPECT_TRUE(none.empty());
}

}  // namespace
}  // namespace remote_touch::shown_run_test
