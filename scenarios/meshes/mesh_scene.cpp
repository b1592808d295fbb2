#include "scenarios/meshes/mesh_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "scenarios/meshes/object_view.h"
#include "scenarios/meshes/pose_file.h"

namespace remote_touch {

namespace {

constexpr double kReach_m = 1;

// Returns the time from which all bodies rest; 0 if none of them moves.
double end_of_motion(const std::vector<SceneMesh>& meshes, const PosePath& camera) {
  double end_s = 0;
  const auto add = [&end_s](const PosePath& path) {
    if (path.poses().size() > 1) end_s = std::max(end_s, path.duration_s());
  };
  for (const SceneMesh& mesh : meshes) add(mesh.path);
  add(camera);
  return end_s;
}

}  // namespace

Parameters parameters(MeshScene::Settings& s) {
  const Parameters own = {
      {"frame_rate_hz", &s.frame_rate_hz, 1e-3, 10000, "frames of the camera per second, f_c"},
      {"duration_s", &s.duration_s, 0, 1e4,
       "objects and camera stop at this time; 0: at the ends of their paths"},
  };
  return appended(own, parameters(s.sensor));
}

MeshScene::MeshScene(const Settings& settings, std::vector<SceneMesh> meshes,
                     const std::optional<PosePath>& camera_path, const NoiseKey& key, const Kernels& kernels)
    : settings_(settings),
      meshes_(std::move(meshes)),
      camera_(settings.sensor, camera_path, key, kernels),
      camera_has_path_(camera_path.has_value()),
      motion_ends_s_(end_of_motion(meshes_, camera_.path())) {
  if (settings.duration_s > 0) motion_ends_s_ = std::min(motion_ends_s_, settings.duration_s);
  for (const SceneMesh& mesh : meshes_) objects_.push_back(mesh.object);
  if (motion_ends_s_ == 0) still_view_ = camera_.view(meshes_, 0);
}

int MeshScene::frame_count() const {
  constexpr int kMax = std::numeric_limits<int>::max();
  if (camera_.noisy()) return kMax;
  const double moving_frames = std::ceil(motion_ends_s_ * settings_.frame_rate_hz - 1e-6);
  return static_cast<int>(std::min(moving_frames + 1, 1.0 * kMax));
}

std::vector<Phase> MeshScene::phases() const {
  if (motion_ends_s_ == 0) return {};
  return {{"the motion of the scene", 0, motion_ends_s_}};
}

// Objects and camera are where their paths are at this time.
double MeshScene::moving_time_s(double time_s) const {
  return std::min(time_s, motion_ends_s_);
}

std::vector<Note> MeshScene::input_notes() const {
  constexpr int kMoments = 30;
  constexpr std::size_t kSamples = 200;
  const int moments = motion_ends_s_ > 0 ? kMoments : 1;
  std::vector<Note> notes;
  for (const SceneMesh& mesh : meshes_) {
    if (!mesh.object.is_closed) continue;
    const std::vector<SampledPoint> samples = surface_samples(*mesh.object.shape, kSamples);
    const auto samples_seen = [&](const auto& meant) {
      std::size_t count = 0;
      for (int i = 0; i < moments; ++i) {
        const double time_s = motion_ends_s_ * i / std::max(1, moments - 1);
        const RigidTransform X_CW = RigidTransform(meant(camera_.path().at(time_s))).inverse();
        count += count_in_image(samples, X_CW * mesh.path.at(time_s), camera_.intrinsics());
      }
      return count;
    };
    if (samples_seen([](const RigidTransform& X) { return X; }) > 0) continue;
    const Vec3 p_C = camera_.path().at(0).inverse() * (mesh.path.at(0) * samples.front().point);
    char place[96];
    std::snprintf(place, sizeof place, "at x %.3g, y %.3g, z %.3g m in the frame of the camera", p_C.x(),
                  p_C.y(), p_C.z());
    std::string text = mesh.object.name + " is at no time in the image: at the start it is " + place;
    std::string others;
    std::size_t most = 0;
    for (const OtherMeaning& meaning : other_meanings())
      if (const std::size_t count = camera_has_path_ ? samples_seen(meaning.of) : 0; count > most)
        most = count, others = std::string("; with ") + meaning.text + " of the camera it is in the image";
    text += others;
    notes.push_back({"not in view", text});
  }
  return notes;
}

PointCloud MeshScene::made(int frame) const {
  const double time_s = moving_time_s(captured_s(frame));
  return still_view_ ? camera_.cloud(*still_view_, frame, time_s)
                     : camera_.cloud(camera_.view(meshes_, time_s), frame, time_s);
}

std::shared_ptr<const NeighbourSearch> MeshScene::points(int frame) const {
  return frames_.get(static_cast<std::size_t>(frame), [&] { return make_search(made(frame)); });
}

// The search of an image stores its points in their order.
PointCloud MeshScene::cloud(int frame) const {
  return dynamic_cast<const CloudSearch&>(*points(frame)).cloud();
}

// Returns the poses of all objects, object to world frame.
std::vector<std::optional<RigidTransform>> MeshScene::poses(double time_s) const {
  std::vector<std::optional<RigidTransform>> X_WO;
  X_WO.reserve(meshes_.size());
  for (const SceneMesh& mesh : meshes_) X_WO.push_back(mesh.path.at(moving_time_s(time_s)));
  return X_WO;
}

// Makes no list of poses, because a slave of a live session asks here, and its loop must not allocate.
NearestOnObjects MeshScene::nearest(const Vec3& p_W, double time_s) const {
  NearestOnObjects result;
  if (!p_W.allFinite()) return result;
  for (std::size_t i = 0; i < objects_.size(); ++i)
    take_nearer(result, objects_, i, meshes_[i].path.at(moving_time_s(time_s)), p_W, kReach_m);
  return result;
}

double MeshScene::signed_distance(const Vec3& p_W, double time_s) const {
  return nearest(p_W, time_s).distance_m;
}

// The gradient of the distance is unknown where parts with different normals are equally near.
Vec3 MeshScene::true_normal(const Vec3& p_W, double time_s) const {
  const Vec3 gradient = Scenario::true_normal(p_W, time_s);
  return gradient.allFinite() ? nearest(p_W, time_s).normal : gradient;
}

}  // namespace remote_touch
