// The errors of camera and renderer, told apart in runs over a recording whose camera's error is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "analysis/trace/contact_measures.h"
#include "analysis/trace/measures.h"
#include "runners/experiment/simulation/simulation.h"
#include "tests/support/recorded_wall.h"

namespace remote_touch::recorded_truth_run_test {
namespace {

constexpr double kDepthStep_m = 2e-5;  // two units of the depth image

class RecordedTruthRun : public testing::Test {
 protected:
  Trace press(const std::string& renderer, const std::string& path, const std::string& more = "") {
    const std::string json = R"({"scenario": )" + recorded_wall::scenario(path, more) +
                             R"(, "renderer": {"name": ")" + renderer + R"("}, "trajectory": )" +
                             recorded_wall::kPress + R"(, "duration_s": 0.5})";
    SimulationOptions options;
    options.find_true_contact = true;
    options.report = &report_;
    return simulate(Experiment::from_json(json, "test"), options);
  }
  const TestFolder folder_{"recorded_truth_run_test"};
  const std::string wall_ = recorded_wall::write(folder_);
  RunReport report_;
};

// A god-object lies on the mesh of the points, which is the plane of the measurement.
TEST_F(RecordedTruthRun, AGodObjectHasTheErrorOfTheCameraOnly) {
  const Trace trace = press("god-object", wall_);
  ASSERT_TRUE(trace.has_measured_surface());
  EXPECT_LT(rms_renderer_error_m(trace), kDepthStep_m);
  EXPECT_NEAR(rms_camera_error_m(trace), recorded_wall::kCameraError_m, kDepthStep_m);
  EXPECT_NEAR(mean_camera_error_m(trace), recorded_wall::kCameraError_m, kDepthStep_m) << "it is in front";
  EXPECT_NEAR(rms_contact_error_m(trace), recorded_wall::kCameraError_m, 2 * kDepthStep_m);
  EXPECT_EQ(popped_through(trace), 0);
}

// The ball sinks between four points, whose diagonal is s = 2.2 mm: by r_c - sqrt(r_c^2 - s^2 / 4) at most.
// Root mean squares obey the triangle inequality.
TEST_F(RecordedTruthRun, AProxyAddsAtMostItsSinking) {
  const Trace trace = press("proxy", wall_);
  const double sinking_m = 0.005 - std::sqrt(0.005 * 0.005 - 0.0011 * 0.0011);
  const double renderer_m = rms_renderer_error_m(trace);
  EXPECT_LT(renderer_m, sinking_m + kDepthStep_m);
  EXPECT_NEAR(rms_camera_error_m(trace), recorded_wall::kCameraError_m, kDepthStep_m);
  EXPECT_NEAR(rms_contact_error_m(trace), recorded_wall::kCameraError_m, renderer_m + kDepthStep_m);
}

// A penalty force has no proxy. Its contact point is where the force would end.
TEST_F(RecordedTruthRun, TheCamerasErrorIsThatOfItsPlaceForEveryRenderer) {
  for (const char* renderer : {"penalty", "surfels", "mls-surface", "implicit-surface", "tracked-sheet"}) {
    const Trace trace = press(renderer, wall_);
    EXPECT_NEAR(rms_camera_error_m(trace), recorded_wall::kCameraError_m, kDepthStep_m) << renderer;
    for (const Trace::TrueContact& at : trace.contact)
      if (!std::isnan(at.measured_height_m) && !std::isnan(at.height_m)) {
        ASSERT_NEAR(at.height_m, at.measured_height_m + recorded_wall::kCameraError_m, kDepthStep_m)
            << renderer;
      }
  }
}

TEST_F(RecordedTruthRun, BothDistancesAreStoredSideBySide) {
  const Trace trace = press("proxy", wall_);
  std::size_t known = 0;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    if (std::isnan(trace.measured_distance_m[i]) || std::isnan(trace.signed_distance_m[i])) continue;
    ++known;
    ASSERT_NEAR(trace.signed_distance_m[i] - trace.measured_distance_m[i], recorded_wall::kCameraError_m,
                kDepthStep_m)
        << i;
  }
  EXPECT_GT(known, trace.length() / 2);
}

// The centre of the proxy is seen 2.8 pixels to the right of the contact point. A hole beside the contact is
// within 6 mm of the centre's pixel, but not of the pixel of the contact point.
TEST_F(RecordedTruthRun, TheMeasuredSurfaceIsThatOfThePixelWithTheContact) {
  const TestFolder folder("recorded_truth_run_hole");
  const Trace trace = press("god-object", recorded_wall::write(folder, 38), R"(, "truth_radius_m": 0.004)");
  EXPECT_NEAR(rms_camera_error_m(trace), recorded_wall::kCameraError_m, kDepthStep_m);
  const Trace ball = press("proxy", recorded_wall::write(folder, 37), R"(, "truth_radius_m": 0.004)");
  EXPECT_TRUE(std::isnan(ball.measured_distance_m.back()));
  EXPECT_NEAR(rms_camera_error_m(ball), recorded_wall::kCameraError_m, kDepthStep_m);
}

TEST_F(RecordedTruthRun, ATruthThatIsTheMeasurementHasOneErrorOnly) {
  const Trace trace = press("god-object", wall_, R"(, "truth": "measured")");
  EXPECT_FALSE(trace.has_measured_surface());
  EXPECT_TRUE(std::isnan(rms_camera_error_m(trace)));
  EXPECT_LT(rms_contact_error_m(trace), kDepthStep_m) << "the camera's error cannot be found";
}

TEST_F(RecordedTruthRun, StatesTheTruthAndItsUncertainty) {
  press("proxy", wall_);
  EXPECT_HAS(text_of(report_), "; truth: meshes of truth/ (wall), uncertainty 3 mm\n");
  press("proxy", wall_, R"(, "truth": "measured")");
  EXPECT_HAS(text_of(report_), "; truth: the measured surface\n");
  std::filesystem::remove(folder_ / "wall/truth/truth.json");
  press("proxy", wall_);
  EXPECT_HAS(text_of(report_), "; truth: meshes of truth/ (wall), uncertainty not stated\n");
  std::filesystem::remove_all(folder_ / "wall/truth");
  EXPECT_FALSE(press("proxy", wall_).has_measured_surface());
  EXPECT_EQ(text_of(report_).find("truth"), std::string::npos) << text_of(report_);
}

TEST_F(RecordedTruthRun, PrintsBothErrorsAmongItsMainMeasures) {
  const Trace trace = press("proxy", wall_);
  std::vector<std::string> names;
  for (const MeasuredValue& each : main_measures(measured_values(built_in_measures(), trace), Fixtures::none))
    names.push_back(each.measure->name);
  for (const char* name : {"popped_through", "popped_through_truth", "rms_contact_error", "rms_camera_error",
                           "rms_renderer_error"})
    EXPECT_EQ(std::ranges::count(names, name), 1) << name;
}

}  // namespace
}  // namespace remote_touch::recorded_truth_run_test
