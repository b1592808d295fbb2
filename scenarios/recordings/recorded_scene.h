// A recording as a scenario, and the fixture rule that selects the points whose pixels are marked in a mask:
// an image that any segmentation may have made.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "core/parameters/parameter.h"
#include "core/points/point_cloud.h"
#include "scenarios/objects/recorded_truth.h"
#include "scenarios/recordings/camera_path.h"
#include "scenarios/recordings/frame_statistics.h"
#include "scenarios/recordings/recording.h"
#include "scenarios/simulated/scenario.h"

namespace remote_touch {

class ImageMask final : public FixtureRule {
 public:
  struct Settings {
    FixtureValues values;
    std::string path;
  };
  // Reads the mask: a PNG of any kind that read_colour_png() accepts, of the size of the frames. A pixel that
  // is neither black nor fully transparent selects its point. Throws InputError if the file cannot be read.
  explicit ImageMask(const Settings& settings);
  // Throws InputError unless the cloud is an image of the size of the mask.
  void require(const PointCloud& cloud) const override;
  std::vector<double> weights(const PointCloud& cloud) const override;

 private:
  std::string path_;
  int width_ = 0, height_ = 0;
  std::vector<std::uint32_t> mask_;
};

Parameters parameters(ImageMask::Settings& s);
std::string validate(const ImageMask::Settings& s);
InputPart input_files(const ImageMask::Settings& s);

// The surface that a depth image shows: a plane through the points around a pixel. Returns the distance of p
// to a plane through the points of the cloud around p's pixel, within radius_m, m; positive towards the
// camera. NaN at holes and depth edges, outside the image, behind the camera, and for clouds without a
// camera.
double distance_to_measured(const PointCloud& cloud, const Vec3& p_W, double radius_m);

// A recorded sequence of depth images or clouds, streamed at the recorded times or at a chosen rate.
//
// The world frame is the camera's, x right, y down, z forward, unless the camera is registered to another or
// its poses are known. The true surface is the measured one, or that of the meshes in the folder truth/ of
// the recording, see recorded_truth.h.
class RecordedScene : public Scenario {
 public:
  using Playback = FrameTimes::Playback;
  enum class Truth { automatic, measured, mesh };
  struct Settings {
    std::string path;
    int first_frame = 0;
    int last_frame = -1;
    Playback playback = Playback::hold;
    double frame_rate_hz = 0;
    double max_depth_m = 3;  // along the camera's axis; does not apply to clouds that are no image
    Truth truth = Truth::automatic;
    double truth_radius_m = 0.006;
    double truth_reach_m = 0.03;
    std::string camera_poses;  // file or folder in the folder of the recording
    PoseDirection pose_direction = PoseDirection::camera_to_world;
    Vec3 camera_position_m = Vec3::Zero();  // position and rotation vector of the camera, base frame
    Vec3 camera_rotation_deg = Vec3::Zero();
    BagChoice bag;  // used if the path is a bag of ROS
  };

  // Throws InputError when the recording or its truth cannot be read, when no true object is in the image or
  // another depth scale would make them fit, and when a later frame is not of the layout of the first one
  // that is used, see conform(). read_mesh: reads the meshes of the truth. Without it the truth is the
  // measured surface.
  RecordedScene(const Settings& settings, const NoiseKey& key, const Kernels& kernels,
                const MeshReader& read_mesh = {});

  // The mean rate at which the frames are played.
  double frame_rate_hz() const override { return times_.rate_hz(); }
  int frame_count() const override;
  double captured_s(int frame) const override { return times_.captured_s(frame); }
  // "office: 71 frame(s) from depth PNG at 29.9 Hz, 640 x 480 pixels, f = ...; 12 read: ..."
  std::string input() const override;
  std::vector<Note> input_notes() const override;
  // The pose at the first frame, if the camera moves.
  std::optional<RigidTransform> sensor_pose() const override { return camera_.pose(times_.source(0)); }
  std::shared_ptr<const NeighbourSearch> points(int frame) const override;
  PointCloud cloud(int frame) const override;
  // Meshes: the distance to the union of the true objects at their poses in the newest frame, NaN farther
  // than truth_reach_m from all of them, beyond the border of an open one, and outside the mask. Otherwise it
  // is the distance to the measured surface.
  double signed_distance(const Vec3& p_W, double time_s) const override;
  // The distance to a plane through the points of the newest frame around p's pixel, see above.
  std::optional<double> measured_distance(const Vec3& p_W, double time_s) const override {
    return truth_ ? std::optional(measured_m(p_W, time_s)) : std::nullopt;
  }
  // Returns NaN if the truth is the measured surface, which is no independent truth: a normal would be judged
  // by the error of the measurement.
  Vec3 true_normal(const Vec3& p_W, double time_s) const override;
  // Both truths belong to the newest frame.
  double truth_time_s(double time_s) const override { return captured_s(newest_frame(time_s)); }
  // "meshes of truth/ (cube, table), uncertainty 3 mm", or "the measured surface".
  std::string truth_text() const override;
  // Meshes: the true objects at their poses in the newest frame. Otherwise empty.
  std::vector<PosedMesh> true_meshes(double time_s) const override;
  // The true objects; null if the truth is the measured surface.
  const RecordedTruth* truth() const { return truth_.get(); }
  // The frame of the recording that is the newest at a time, and the pose of its camera.
  std::size_t source_at(double time_s) const { return times_.source(newest_frame(time_s)); }
  RigidTransform camera_at(double time_s) const;

 private:
  void require_points() const;
  void read_truth(const MeshReader& read_mesh);
  PointCloud as_recorded(std::size_t source, RigidTransform& X_FC) const;
  std::vector<Note> unusual_rate() const;
  PointCloud registered(std::size_t source) const;
  void compare(std::size_t source, const PointCloud& cloud) const;
  const PointCloud& newest_cloud(double time_s) const;
  double measured_m(const Vec3& p_W, double time_s) const;

  const Settings settings_;
  RecordingIndex recording_;  // its camera is that of the layout
  const CameraPath camera_;
  const FrameTimes times_;
  std::unique_ptr<const RecordedTruth> truth_;
  // 12 MB each. Renderer, trajectory and truth use frames in turn, and a short part is played many times.
  mutable KeptFrames cache_{8};
  mutable FrameStatistics statistics_;
  mutable PoseFit fit_;
  mutable std::set<std::size_t> is_compared_;  // the frames in fit_
  mutable std::size_t unused_viewpoints_ = 0;  // number of files read whose VIEWPOINT is not used
  mutable std::optional<FrameLayout> layout_;  // layout of frame 0, which the constructor reads
};

Parameters parameters(RecordedScene::Settings& s);
std::string validate(const RecordedScene::Settings& s);
InputPart input_files(const RecordedScene::Settings& s);  // part of the recording that the scene reads

}  // namespace remote_touch
