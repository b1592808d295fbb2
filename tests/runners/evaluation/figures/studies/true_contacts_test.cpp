#include "runners/evaluation/figures/studies/true_contacts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "analysis/trace/contact_measures.h"
#include "runners/evaluation/figures/studies/camera_errors.h"
#include "runners/experiment/simulation/simulation.h"
#include "tests/runners/evaluation/figures/studies/true_wall.h"

namespace remote_touch::true_contacts_test {
namespace {

using namespace true_wall;

TEST(TrueImage, ShowsTheFrontAtItsDepthWithItsNormal) {
  const TestFolder folder("true_image_test");
  write(folder);
  const WallScene scene(folder);
  const RecordedTruth& truth = *(*scene).truth();
  const CameraIntrinsics camera{kWidth, kHeight, kFocal_px, kFocal_px, 80, 60};
  const RasterImage image = true_image(truth, 0, camera);
  const std::size_t middle = 60 * kWidth + 80;
  EXPECT_EQ(image.mesh[middle], 0);
  EXPECT_NEAR(image.depth.z_m[middle], kFront_m, 1e-6);
  EXPECT_TRUE(true_normal_C(truth, 0, image, middle).isApprox(-Vec3::UnitZ(), 1e-9));
  EXPECT_EQ(image.mesh[0], -1);
}

TEST(TouchedPoints, AreOnTheMeshInTheMiddleOfTheObject) {
  const TestFolder folder("touched_points_test");
  write(folder);
  const WallScene scene(folder);
  const std::vector<TouchedPoint> points = touched_points(*scene, 0, 3);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].object, "box");
  EXPECT_NEAR(points[0].p_O.x(), 0, 0.01);
  EXPECT_NEAR(points[0].p_O.y(), 0, 0.01);
  EXPECT_NEAR(points[0].p_O.z(), 0, 1e-6) << "on the true surface, not on the measured one";
  EXPECT_TRUE(points[0].outwards_O.isApprox(-Vec3::UnitZ(), 1e-9));
  EXPECT_TRUE(touched_points(*scene, 0, 0).empty());
}

TEST(RecordingWindow, HasThePointsOfTheRecordingAroundAPointThatMoves) {
  const TestFolder folder("recording_window_test");
  write(folder, 0.004);
  const WallScene scene(folder);
  const auto windows = windows_around(touched_points(*scene, 0, 1), *scene, kFrames);
  ASSERT_EQ(windows.size(), 1u);
  const RecordingWindow& window = *windows[0];
  ASSERT_EQ(window.frame_count(), kFrames);
  EXPECT_NEAR(window.p_W(5).x() - window.p_W(0).x(), 5 * 0.004, 1e-9);
  for (const int frame : {0, 5}) {
    const PointCloud cloud = window.cloud(frame), whole = (*scene).cloud(frame);
    const CameraIntrinsics& camera = cloud.image->camera;
    // A pixel is at the same place by either camera.
    const int left = static_cast<int>(80 - camera.cx), top = static_cast<int>(60 - camera.cy);
    EXPECT_LT(camera.width, kWidth);
    for (const int row : {0, camera.height - 1})
      for (const int column : {0, camera.width - 1}) {
        const auto in_window = static_cast<std::size_t>(row * camera.width + column);
        const auto in_whole = static_cast<std::size_t>((row + top) * kWidth + column + left);
        EXPECT_EQ(cloud.z[in_window], whole.z[in_whole]) << frame;
        EXPECT_EQ(cloud.x[in_window], whole.x[in_whole]) << frame;
      }
  }
}

TEST(RecordingWindow, MeasuresTheDistancesOfTheRecording) {
  const TestFolder folder("window_distance_test");
  write(folder, 0.004);
  const WallScene scene(folder);
  const auto windows = windows_around(touched_points(*scene, 0, 1), *scene, kFrames);
  for (const int frame : {0, 3}) {
    const double time_s = windows[0]->captured_s(frame);
    const Vec3 p_W = windows[0]->p_W(frame) - Vec3(0.002, 0.003, 0.004);
    EXPECT_EQ(windows[0]->measured_distance(p_W, time_s), (*scene).measured_distance(p_W, time_s));
    EXPECT_EQ(windows[0]->signed_distance(p_W, time_s), (*scene).signed_distance(p_W, time_s));
    EXPECT_NEAR(windows[0]->signed_distance(p_W, time_s), 0.004, 1e-6);
  }
}

constexpr double kRest_m = 0.005;
const Toucher kProxy{"proxy", R"({"name": "proxy"})", "", kRest_m};

class TrueContacts : public testing::Test {
 protected:
  TrueContacts() {
    write(folder_, 0.002);
    scene_ = std::make_unique<WallScene>(folder_);
    windows_ = windows_around(touched_points(**scene_, 0, 1), **scene_, kFrames);
  }
  const RecordingWindow& window() const { return *windows_.at(0); }
  Experiment experiment(const Toucher& toucher) const {
    return pressing_experiment(scenario(folder_), window(), toucher);
  }

  const TestFolder folder_{"true_contacts_test"};
  const Kernels& kernels_ = kernels_for(best_isa());
  std::unique_ptr<WallScene> scene_;
  std::vector<std::unique_ptr<const RecordingWindow>> windows_;
};

TEST_F(TrueContacts, TellTheErrorOfTheCameraFromThatOfTheRenderer) {
  for (const Toucher& toucher : compared_renderers()) {
    const std::vector<ContactError> errors = contact_errors(
        contact_points(experiment(toucher), window(), toucher.rest_distance_m, kernels_), window());
    ASSERT_EQ(errors.size(), static_cast<std::size_t>(kFrames));
    EXPECT_TRUE(std::isnan(errors[0].total_m())) << "the hand is on its way";
    for (std::size_t frame = 3; frame < errors.size(); ++frame) {
      EXPECT_NEAR(errors[frame].camera_m, kError_m, 1e-4) << toucher.name << ", frame " << frame;
      // Half a voxel of the ball is 0.25 mm; the proxy sinks between points that are 2.5 mm apart.
      EXPECT_NEAR(errors[frame].renderer_m, 0, 4e-4) << toucher.name << ", frame " << frame;
    }
  }
}

// The run ends before the recording repeats its last frame, which the window does not do.
TEST_F(TrueContacts, AreThoseOfARunOverTheWholeFrames) {
  for (const Toucher& toucher : {kProxy, toucher_of(depth_settings().at(default_setting()))}) {
    auto configuration = nlohmann::ordered_json::parse(experiment(toucher).to_json());
    configuration["duration_s"] = window().captured_s(kFrames - 1) + 0.03;
    const Experiment pressed = Experiment::from_json(configuration);
    const std::vector<Vec3> contacts_W = contact_points(pressed, window(), kRest_m, kernels_);
    const Trace trace = simulate(pressed);
    std::size_t compared = 0;
    for (std::size_t i = 0; i < trace.length(); ++i) {
      const bool is_last = i + 1 == trace.length() || trace.frame_update(i + 1);
      if (!is_last || trace.frame_index[i] < 0) continue;
      const auto frame = static_cast<std::size_t>(trace.frame_index[i]);
      if (!contacts_W.at(frame).allFinite()) continue;
      EXPECT_EQ(contacts_W[frame], contact_point(trace, i, kRest_m)) << toucher.name << ", frame " << frame;
      ++compared;
    }
    EXPECT_GE(compared, 3u);
  }
}

const std::vector<ContactError> kErrors = {{0.003, -0.001}, {}, {-0.004, 0.001}, {0, 0}};

TEST(ErrorStatistics, AreOverTheFramesWithKnownErrors) {
  const ErrorStatistics renderer = statistics_of(kErrors, renderer_error_m);
  EXPECT_EQ(renderer.frames, 3);
  EXPECT_NEAR(renderer.rms_m, std::sqrt(25e-6 / 3), 1e-12);
  EXPECT_NEAR(renderer.mean_m, -0.001 / 3, 1e-12);
  EXPECT_NEAR(statistics_of(kErrors, total_error_m).rms_m, std::sqrt(13e-6 / 3), 1e-12);
  EXPECT_NEAR(statistics_of(kErrors, renderer_error_m, 0.001).rms_m, std::sqrt(26e-6 / 3), 1e-12);
}

TEST(ErrorStatistics, HaveNoValueIfNothingIsKnown) {
  const ErrorStatistics statistics = statistics_of({{}, {}}, total_error_m);
  EXPECT_EQ(statistics.frames, 0);
  EXPECT_TRUE(std::isnan(statistics.rms_m));
  EXPECT_TRUE(std::isnan(statistics.mean_m));
}

TEST(FrameNoise, IsOverSuccessiveKnownFramesOnly) {
  EXPECT_NEAR(frame_noise_m(kErrors, renderer_error_m), 0.004 / std::sqrt(2.0), 1e-12);
  EXPECT_TRUE(std::isnan(frame_noise_m({{0.001, 0}, {}, {0.002, 0}}, renderer_error_m)));
}

TEST(CommonFrames, AreKnownInAllRuns) {
  std::vector<std::vector<ContactError>> runs = {{{1, 1}, {2, 2}, {}}, {{3, 3}, {}, {4, 4}}};
  keep_common_frames(runs);
  for (const std::vector<ContactError>& run : runs) {
    EXPECT_FALSE(std::isnan(run[0].total_m()));
    EXPECT_TRUE(std::isnan(run[1].total_m()));
    EXPECT_TRUE(std::isnan(run[2].total_m()));
  }
}

TEST(ComparedSettings, HaveTheDefaultPipelineAmongThem) {
  EXPECT_EQ(pipeline_of(depth_settings().at(default_setting())), DepthPipelineSettings());
  EXPECT_FALSE(pipeline_of(depth_settings().at(0))->filter);
  for (std::size_t i = 0; i < depth_settings().size(); ++i)
    EXPECT_EQ(pipeline_of(depth_settings()[i]).has_value(), i < spatial_count()) << i;
}

TEST(BestSetting, IsTheSmallestValueAndNeverNan) {
  EXPECT_EQ(best_setting({kNoValue, 3, 1, kNoValue, 2}), 2u);
  EXPECT_EQ(best_setting({1, kNoValue}), 0u);
}

}  // namespace
}  // namespace remote_touch::true_contacts_test
