// A sweep over the truth of a recording: the same runs, judged by the measurement and by the meshes.
#include <gtest/gtest.h>

#include <cmath>

#include "runners/sweep/sweep_run.h"
#include "tests/support/recorded_wall.h"

namespace remote_touch::truth_sweep_test {
namespace {

TEST(TruthSweep, JudgesTheSameRunsByBothSurfaces) {
  const TestFolder folder("truth_sweep_test");
  const std::string experiment = R"({"scenario": )" + recorded_wall::scenario(recorded_wall::write(folder)) +
                                 R"(, "renderer": {"name": "god-object"}, "trajectory": )" +
                                 recorded_wall::kPress + R"(, "duration_s": 0.5})";
  const Sweep sweep =
      Sweep::from_json(R"({"title": "truth", "experiment": )" + experiment +
                           R"(, "axes": [{"parameter": "scenario.truth", "values": ["measured", "mesh"]}],
             "measures": ["rms_contact_error", "rms_renderer_error", "rms_camera_error", "max_force"]})",
                       "test");
  const SweepResult result = run_sweep(sweep, {});
  const auto value = [&](const char* measure, std::size_t run) { return result.measure(measure)[run]; };
  EXPECT_EQ(value("max_force", 0), value("max_force", 1)) << "the truth changes no force";
  EXPECT_LT(value("rms_contact_error", 0), 2e-5);
  EXPECT_NEAR(value("rms_contact_error", 1), recorded_wall::kCameraError_m, 4e-5);
  EXPECT_TRUE(std::isnan(value("rms_camera_error", 0)));
  EXPECT_TRUE(std::isnan(value("rms_renderer_error", 0)));
  EXPECT_NEAR(value("rms_camera_error", 1), recorded_wall::kCameraError_m, 2e-5);
  EXPECT_LT(value("rms_renderer_error", 1), 2e-5);
}

}  // namespace
}  // namespace remote_touch::truth_sweep_test
