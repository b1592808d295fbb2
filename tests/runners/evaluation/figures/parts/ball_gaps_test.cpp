#include "runners/evaluation/figures/parts/ball_gaps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace remote_touch::ball_gaps_test {
namespace {

constexpr double kRadius_m = 0.005, kHz = 10, kSpeed_m_per_s = 0.2;

// A plane that rises from y = 0.
class RisingPlane final : public Scenario {
 public:
  double frame_rate_hz() const override { return kHz; }
  int frame_count() const override { return 100; }
  PointCloud cloud(int) const override { return {}; }
  double signed_distance(const Vec3& p_W, double time_s) const override {
    return p_W.y() - kSpeed_m_per_s * time_s;
  }
};

// Adds a tick with a ball at this height. hip_m: how far the HIP is below it.
void add_tick(Trace& trace, double time_s, int frame, double height_m, double hip_m) {
  const Vec3 proxy_W(0.3, height_m, 0.1);
  trace.time_s.push_back(time_s);
  trace.frame_index.push_back(frame);
  trace.proxy_position_m.push_back(proxy_W);
  trace.hip_position_m.push_back(proxy_W - hip_m * Vec3::UnitY());
  trace.signed_distance_m.push_back(RisingPlane().signed_distance(proxy_W, time_s));
}

TEST(BallGaps, AreToTheMovingSurfaceAndToThatOfTheFrame) {
  Trace trace;
  add_tick(trace, 0.35, 3, kSpeed_m_per_s * 0.3 + kRadius_m + 0.001, 0.02);
  const std::vector<BallGap> gaps = ball_gaps(trace, RisingPlane(), kRadius_m);
  ASSERT_EQ(gaps.size(), 1u);
  EXPECT_NEAR(gaps[0].at_capture_m, 0.001, 1e-12);
  EXPECT_NEAR(gaps[0].now_m, 0.001 - kSpeed_m_per_s * 0.05, 1e-12);
}

TEST(BallGaps, AreNanWithoutAFrameOrWithoutContact) {
  Trace trace;
  add_tick(trace, 0, -1, 0.1, 0.02);
  add_tick(trace, 0.1, 1, 0.1, kRadius_m);
  for (const BallGap& gap : ball_gaps(trace, RisingPlane(), kRadius_m)) {
    EXPECT_TRUE(std::isnan(gap.now_m));
    EXPECT_TRUE(std::isnan(gap.at_capture_m));
  }
}

TEST(BallGapStatistics, LeaveOutNanAndUseMagnitudes) {
  const std::vector<BallGap> gaps = {{0.003, 0}, {kNoValue, kNoValue}, {-0.004, 0}};
  EXPECT_NEAR(rms_gap_m(gaps, &BallGap::now_m), 0.005 / std::sqrt(2.0), 1e-15);
  EXPECT_EQ(max_gap_m(gaps, &BallGap::now_m), 0.004);
  EXPECT_TRUE(std::isnan(rms_gap_m({{}, {}}, &BallGap::now_m)));
  EXPECT_TRUE(std::isnan(max_gap_m({{}, {}}, &BallGap::now_m)));
}

Experiment experiment_with(const std::string& sensor) {
  return Experiment::from_json(R"({"scenario": {"name": "mesh-scene", "mesh": "block", "sensor": )"
                               R"("structured-light")" +
                                   sensor + R"(}, "renderer": {"name": "proxy"}, )" +
                                   R"("trajectory": {"name": "waypoints"}, "duration_s": 1})",
                               "test");
}

TEST(DepthErrorOfAnExperiment, IsThatOfThePublishedSensor) {
  // f = 580 px, b = 75 mm, noise 1/16 px, steps of 1/8 px
  const DepthError error = depth_error(experiment_with(""), 0.7);
  EXPECT_NEAR(error.sigma_m, 0.49 / (580 * 0.075) / 16, 1e-12);
  EXPECT_NEAR(error.rounding_m, 0.49 / (580 * 0.075) / 16, 1e-12);
  EXPECT_NEAR(error.largest_m(), 4 * error.sigma_m, 1e-12);
}

TEST(DepthErrorOfAnExperiment, FollowsTheSettings) {
  const DepthError error = depth_error(
      experiment_with(
          R"(, "noise_px": 0.5, "disparity_step_px": 0, "baseline_m": 0.1, "disparity_focal_px": 400)"),
      0.7);
  EXPECT_NEAR(error.sigma_m, 0.49 / (400 * 0.1) / 2, 1e-12);
  EXPECT_EQ(error.rounding_m, 0);
}

// Four columns and two rows of points, 2 mm and 3 mm apart. The last column is 20 mm behind.
PointCloud image_of_points() {
  PointCloud cloud;
  cloud.image = ImageLayout{};
  cloud.image->camera.width = 4, cloud.image->camera.height = 2;
  for (int v = 0; v < 2; ++v)
    for (int u = 0; u < 4; ++u) cloud.append({0.002 * u, 0.003 * v, u == 3 ? 0.02 : 0});
  return cloud;
}

TEST(SinkBetweenPoints, IsThatOfABallOnFourPoints) {
  const double half_m = 0.5 * std::hypot(0.002, 0.003);
  const auto all = [](std::size_t) { return true; };
  EXPECT_NEAR(deepest_sink_m(image_of_points(), kRadius_m, all),
              kRadius_m - std::sqrt(kRadius_m * kRadius_m - half_m * half_m), 1e-12);
}

TEST(SinkBetweenPoints, IsNanWithoutFourPointsNearEachOther) {
  const auto at_edge = [](std::size_t i) { return i == 2; };
  EXPECT_TRUE(std::isnan(deepest_sink_m(image_of_points(), kRadius_m, at_edge)));
}

}  // namespace
}  // namespace remote_touch::ball_gaps_test
