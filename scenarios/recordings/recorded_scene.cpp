#include "scenarios/recordings/recorded_scene.h"

#include <algorithm>
#include <limits>

#include "core/points/vector.h"
#include "scenarios/files/depth_images.h"
#include "scenarios/files/input_files.h"
#include "scenarios/objects/mesh_object.h"
#include "scenarios/recordings/bag_file.h"

namespace remote_touch {

Parameters parameters(ImageMask::Settings& s) {
  Parameters list = parameters(s.values);
  list.push_back(
      {"path", &s.path, 0, 0,
       "PNG file of the size of the frames; points at pixels that are neither black nor transparent are "
       "selected; up to 8 bits a channel"});
  return list;
}

std::string validate(const ImageMask::Settings& s) {
  if (s.path.empty()) return "path = \"\": expected a PNG file";
  return validate(s.values);
}

InputPart input_files(const ImageMask::Settings& s) {
  return {s.path};
}

ImageMask::ImageMask(const Settings& settings)
    : FixtureRule(settings.values),
      path_(settings.path),
      mask_(read_colour_png(find_input(settings.path), width_, height_)) {}

void ImageMask::require(const PointCloud& cloud) const {
  if (!cloud.image) refuse("image-mask", "the frame is not an image: expected a scenario with a camera");
  const CameraIntrinsics& camera = cloud.image->camera;
  if (camera.width != width_ || camera.height != height_)
    refuse(path_, width_, " x ", height_, " pixels: expected as many as the frames: ", camera.width, " x ",
           camera.height);
}

std::vector<double> ImageMask::weights(const PointCloud& cloud) const {
  require(cloud);
  std::vector<double> weights(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i)
    weights[i] = cloud.point(i).allFinite() && (mask_[i] & 0xFFFFFF) != 0 ? 1 : 0;
  return weights;
}

namespace {

// The plane through the pixels of a window: the mean of all points, and a normal from the differences along
// its rows and columns. Not usable if a pixel is missing, or if the depths in the camera differ by more than
// max_width_m, which indicates an edge.
struct Patch {
  Vec3 mean = Vec3::Zero(), normal = Vec3::Zero();
  bool usable = false;
};

Patch patch_around(const PointCloud& cloud, const RigidTransform& X_CW, int u, int v, int half,
                   double max_width_m) {
  const CameraIntrinsics& camera = cloud.image->camera;
  Patch patch;
  if (u < half || v < half || u + half >= camera.width || v + half >= camera.height) return patch;
  Vec3 across = Vec3::Zero(), down = Vec3::Zero();
  double min_depth = std::numeric_limits<double>::infinity(), max_depth = -min_depth;
  for (int y = -half; y <= half; ++y) {
    for (int x = -half; x <= half; ++x) {
      const Vec3 p = cloud.point(static_cast<std::size_t>(v + y) * camera.width + (u + x));
      if (!p.allFinite()) return patch;
      patch.mean += p, across += x * p, down += y * p;
      const double depth = (X_CW * p).z();
      min_depth = std::min(min_depth, depth), max_depth = std::max(max_depth, depth);
    }
  }
  patch.mean /= (2 * half + 1) * (2 * half + 1);
  patch.normal = down.cross(across).normalized();  // towards the camera: x right, y down, z forward
  patch.usable = max_depth - min_depth <= max_width_m && patch.normal.allFinite();
  return patch;
}

// Returns the pose of the camera in the base frame: the transform of tf_static is applied first, then the
// registration. If no frame_id is chosen, the former is the identity and the registration keeps its bits.
RigidTransform camera_pose(const RecordedScene::Settings& s, const RecordingIndex& recording) {
  const RigidTransform X_registered =
      Eigen::Translation3d(s.camera_position_m) * rotation(kRadiansPerDegree * s.camera_rotation_deg);
  if (!recording.bag || recording.bag->pose().matrix().isIdentity(0)) return X_registered;
  const RigidTransform X_WC = X_registered * recording.bag->pose();
  if (!is_near_origin(X_WC.translation())) refuse(s.path, far_from_origin("tf_static has its sensor"));
  return X_WC;
}

}  // namespace

double distance_to_measured(const PointCloud& cloud, const Vec3& p_W, double radius_m) {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  if (!p_W.allFinite() || !cloud.image) return unknown;
  const RigidTransform X_CW = cloud.image->X_WC.inverse();
  const Vec3 p_C = X_CW * p_W;
  const CameraIntrinsics& camera = cloud.image->camera;
  const std::optional<std::size_t> pixel = pixel_of(camera, p_C);
  if (!pixel) return unknown;
  const double half = std::clamp(camera.fx * radius_m / p_C.z(), 1.0, 1.0 * camera.width);
  const Patch patch =
      patch_around(cloud, X_CW, static_cast<int>(*pixel) % camera.width,
                   static_cast<int>(*pixel) / camera.width, static_cast<int>(half), 4 * radius_m);
  return patch.usable ? (p_W - patch.mean).dot(patch.normal) : unknown;
}

Parameters parameters(RecordedScene::Settings& s) {
  return {
      {"path", &s.path, 0, 0,
       "recording folder, also in the layout of TUM, 7-Scenes, ScanNet or BOP; folder of PCD files, one PCD file, "
       "or a bag of ROS: .bag, .mcap, .db3, or the folder of a bag; coordinates up to 1000 m from the origin along "
       "each axis"},
      {"first_frame", &s.first_frame, 0, 1e6, "first frame used"},
      {"last_frame", &s.last_frame, -1, 1e6, "last frame used; -1: the last frame of the recording"},
      {"playback", choice(s.playback, {"hold", "loop", "ping-pong"}), 0, 0,
       "after the last frame: hold it, loop from the first, or ping-pong back and forth"},
      {"frame_rate_hz", &s.frame_rate_hz, 0, kMaxFrameRate_hz,
       "frames per second, evenly; 0: at the times of the recording"},
      {"max_depth_m", &s.max_depth_m, 0.01, 100,
       "maximum depth, along the camera's axis; measurements beyond it are discarded; does not apply to clouds "
       "without a camera"},
      {"truth", choice(s.truth, {"auto", "measured", "mesh"}), 0, 0,
       "true surface: the measured one, the meshes in the folder truth/ of the recording, or auto: the meshes "
       "if there are some"},
      {"truth_radius_m", &s.truth_radius_m, 1e-4, 1,
       "radius of the patch whose plane is the measured surface"},
      {"truth_reach_m", &s.truth_reach_m, 1e-3, 10,
       "distance from the true meshes up to which the truth is known"},
      {"camera_poses", &s.camera_poses, 0, 0,
       "poses of a moving camera: a file in the recording's folder, one pose for each frame or with stamps, or a "
       "folder with a file for each frame; empty: the camera does not move"},
      {"pose_direction", choice(s.pose_direction, {"camera-to-world", "world-to-camera"}), 0, 0,
       "what the poses of camera_poses transform, the world being their base frame"},
      {"camera_position_m", &s.camera_position_m, -100, 100,
       "position of the camera in the base frame (registration, 6.2.1); with camera_poses: of the frame of "
       "these poses"},
      {"camera_rotation_deg", &s.camera_rotation_deg, -360, 360,
       "rotation vector (axis times angle) of the camera in the base frame; zero: x right, y down, z forward"},
      {"topic", &s.bag.topic, 0, 0,
       "of a bag: the topic of clouds or depth images; empty: the only one there is"},
      {"camera_info", &s.bag.camera_info, 0, 0,
       "of a bag: the topic of the camera of depth images; empty: the one beside them"},
      {"images", choice(s.bag.images, {"by-name", "measured", "rectified"}), 0, 0,
       "of a bag: depth images are as measured (distorted, intrinsics K), rectified (intrinsics P), or "
       "rectified if the name of their topic has rect"},
      {"frame_id", &s.bag.frame_id, 0, 0,
       "of a bag: the coordinate frame, of tf_static, in which the points are; empty: that of the messages"},
      {"depth_unit_m", &s.bag.depth_unit_m, 0, 1,
       "of a bag: metres per unit of depth images; 0: 1 for floats (32FC1), and for integers (16UC1) the unit "
       "that a RealSense recorded, or else 0.001"},
  };
}

std::string validate(const RecordedScene::Settings& s) {
  if (s.path.empty()) return "path = \"\": expected a recording folder, a PCD file or a bag";
  if (s.last_frame >= 0 && s.last_frame < s.first_frame)
    return "last_frame = " + std::to_string(s.last_frame) +
           ": expected first_frame = " + std::to_string(s.first_frame) + " or more, or -1";
  return {};
}

InputPart input_files(const RecordedScene::Settings& s) {
  return {s.path, s.first_frame, s.last_frame, s.truth != RecordedScene::Truth::measured, s.camera_poses};
}

RecordedScene::RecordedScene(const Settings& settings, const NoiseKey&, const Kernels&,
                             const MeshReader& read_mesh)
    : settings_(settings),
      recording_(index_recording(find_input(settings.path), settings.bag)),
      camera_(camera_pose(settings, recording_), settings.camera_poses, settings.pose_direction, recording_,
              find_input(settings.path)),
      times_(recording_, input_files(settings), settings.playback, settings.frame_rate_hz),
      statistics_(recording_.frames.size()) {
  require_points();
  recording_.camera = layout_->camera.value_or(CameraIntrinsics{});
  if (!layout_->camera && settings_.max_depth_m != Settings{}.max_depth_m)
    refuse(settings_.path,
           "its points form no camera image and have no depth: expected scenario.max_depth_m = ",
           Settings{}.max_depth_m, ", the default, which does not apply to them");
  read_truth(read_mesh);
  if (!truth_) return;
  fit_.add_truth(times_.source(0), cloud(0), *truth_);
  const PoseFit::Cause cause = fit_.cause(*truth_);
  truth_->require_view(recording_.camera, cause.text);
  if (cause.is_depth_scale)
    refuse(settings_.path, "its depths do not fit its true objects", cause.text, ": expected metres");
}

void RecordedScene::read_truth(const MeshReader& read_mesh) {
  if (settings_.truth == Truth::measured) return;
  const std::optional<TruthFolder> folder = read_mesh ? find_truth(find_input(settings_.path)) : std::nullopt;
  if (folder)
    truth_ = std::make_unique<const RecordedTruth>(*folder, frame_names(recording_), settings_.truth_reach_m,
                                                   read_mesh, recording_.camera);
  else if (settings_.truth == Truth::mesh)
    refuse(settings_.path, "has no folder truth/: expected one for scenario.truth = mesh");
}

// Throws InputError if the first frame has no usable point. That is caused by a mistake: another unit,
// another limit, an empty file, or a camera whose centre is far from its image.
void RecordedScene::require_points() const {
  constexpr double kReach_m = 1e4;  // a hundred times the greatest depth
  const PointCloud first = cloud(0);
  for (std::size_t i = 0; i < first.size(); ++i)
    if (first.point(i).norm() <= kReach_m) return;  // false if not finite
  const std::string limit = std::to_string(layout_->camera ? settings_.max_depth_m : kReach_m);
  refuse(settings_.path, "its first frame has no point within ",
         (layout_->camera ? "scenario.max_depth_m = " + limit : limit + " m"), ": ", statistics_.text(),
         ": expected a frame of measured points, in metres",
         (layout_->camera && statistics_.has_points() ? "; the depth scale may be wrong" : ""));
}

int RecordedScene::frame_count() const {
  const bool ends = settings_.playback == Playback::hold || times_.count() == 1;
  return ends ? times_.count() : std::numeric_limits<int>::max();
}

std::string RecordedScene::truth_text() const {
  if (!truth_) return "the measured surface";
  const std::string text = "meshes of " + truth_->name() + ", uncertainty ";
  if (std::isnan(truth_->uncertainty_m())) return text + "not stated";
  return text + formatted("%.3g mm", 1e3 * truth_->uncertainty_m());
}

// The truth is stated if the recording has another one than the measured surface, or if that was chosen.
std::string RecordedScene::input() const {
  const bool states_truth = truth_ || settings_.truth == Truth::measured;
  return description(recording_, times_.text()) + "; " + statistics_.text() +
         (layout_->camera ? "" : "; no camera, so that scenario.max_depth_m does not apply") +
         (camera_.moves() ? "; " + camera_.text() : "") + (states_truth ? "; truth: " + truth_text() : "");
}

// A camera usually has a rate between these limits; outside them the stamps are probably not in seconds. The
// stamps of bags have a defined unit.
std::vector<Note> RecordedScene::unusual_rate() const {
  constexpr double kSlowest_Hz = 1, kFastest_Hz = 1000;
  if (!times_.follows_stamps()) return {};
  const double rate_hz = times_.usual_rate_hz();
  if (rate_hz >= kSlowest_Hz && rate_hz <= kFastest_Hz) return {};
  const char* reason = recording_.bag          ? "this is the rate of the stamps in the messages"
                       : rate_hz < kSlowest_Hz ? "stamps are read as seconds, these may be milliseconds"
                                               : "stamps are read as seconds, these may not be";
  return {{"unusual rate", formatted("%.3g Hz: ", rate_hz) + reason}};
}

std::vector<Note> RecordedScene::input_notes() const {
  std::vector<Note> notes = statistics_.notes(settings_.max_depth_m);
  if (recording_.bag && !recording_.bag->remark().empty())
    notes.push_back({"recording incomplete", recording_.bag->remark()});
  if (recording_.bag && !recording_.bag->camera_change().empty())
    notes.push_back({"camera changes", recording_.bag->camera_change()});
  if (unused_viewpoints_ > 0)
    notes.push_back(
        {"viewpoint unused", "the VIEWPOINT of " + std::to_string(unused_viewpoints_) + " of " +
                                 std::to_string(statistics_.frames_read()) +
                                 " files is not used: seen from there their points form no image"});
  std::vector<bool> is_used;
  for (int i = 0; i < times_.count(); ++i)
    is_used.push_back(statistics_.has(static_cast<std::size_t>(times_.first() + i)));
  const std::vector<Note> of_truth = truth_ ? fit_.truth_notes(*truth_) : std::vector<Note>();
  for (const std::vector<Note>& more : {recording_.notes, unused_frames(is_used), unusual_rate(),
                                        camera_.notes(), fit_.motion_notes(camera_), of_truth})
    notes.insert(notes.end(), more.begin(), more.end());
  for (Note& note : notes) note.text = settings_.path + ": " + note.text;
  return notes;
}

// Returns a frame that has the layout, in its camera's frame, or in its own coordinates if it has no camera.
// Sets X_FC to the pose of the camera in the coordinates of the file.
PointCloud RecordedScene::as_recorded(std::size_t source, RigidTransform& X_FC) const {
  FrameCamera camera;
  PointCloud cloud = read_frame(recording_, source, std::numeric_limits<double>::infinity(), &camera);
  X_FC = camera.X_FC;
  if (layout_)
    conform(*layout_, frame_name(recording_, source), cloud);
  else
    layout_ = layout_of(cloud);
  if (camera.has_unused_viewpoint && !statistics_.has(source)) ++unused_viewpoints_;
  statistics_.add(source, cloud, settings_.max_depth_m);
  drop_beyond(settings_.max_depth_m, cloud);
  return cloud;
}

// Returns a frame in the world frame. Without a registration the points keep the bits that were read.
PointCloud RecordedScene::registered(std::size_t source) const {
  RigidTransform X_FC;
  PointCloud cloud = as_recorded(source, X_FC);
  if (is_far_from_origin(cloud))
    refuse(settings_.path, far_from_origin("frame " + std::to_string(source) + " has all its points"));
  if (!is_near_origin(X_FC.translation()))
    refuse(settings_.path, far_from_origin("frame " + std::to_string(source) + " has its VIEWPOINT"));
  const RigidTransform X_WF = camera_.pose(source);
  const RigidTransform X_WC = X_FC.matrix().isIdentity(0) ? X_WF : X_WF * X_FC;
  const bool is_moved = !X_WC.matrix().isIdentity(0);
  for (std::size_t i = 0; is_moved && i < cloud.size(); ++i) {
    const Vec3 p_W = X_WC * cloud.point(i);
    cloud.x[i] = p_W.x(), cloud.y[i] = p_W.y(), cloud.z[i] = p_W.z();
  }
  if (is_moved && cloud.image) cloud.image->X_WC = X_WC * cloud.image->X_WC;
  compare(source, cloud);
  return cloud;
}

// Compares a frame with the poses of the recording's files when it is read for the first time.
void RecordedScene::compare(std::size_t source, const PointCloud& cloud) const {
  if (!is_compared_.insert(source).second) return;
  fit_.add_motion(source, cloud, camera_);
  if (truth_) fit_.add_truth(source, cloud, *truth_);
}

std::shared_ptr<const NeighbourSearch> RecordedScene::points(int frame) const {
  const std::size_t source = times_.source(frame);
  return cache_.get(source, [&] { return make_search(registered(source)); });
}

// A grid search stores the points in another order than the file, so that the file is read again.
PointCloud RecordedScene::cloud(int frame) const {
  if (!layout_ || layout_->camera) {
    const auto search = points(frame);
    if (search->stored_cloud()->image) return *search->stored_cloud();
  }
  return registered(times_.source(frame));
}

const PointCloud& RecordedScene::newest_cloud(double time_s) const {
  return *points(newest_frame(time_s))->stored_cloud();
}

RigidTransform RecordedScene::camera_at(double time_s) const {
  const PointCloud& cloud = newest_cloud(time_s);
  return cloud.image ? cloud.image->X_WC : camera_.pose(source_at(time_s));
}

double RecordedScene::signed_distance(const Vec3& p_W, double time_s) const {
  if (!truth_) return measured_m(p_W, time_s);
  if (!p_W.allFinite()) return std::numeric_limits<double>::quiet_NaN();
  return truth_->at(source_at(time_s), camera_at(time_s).inverse() * p_W).distance_m;
}

double RecordedScene::measured_m(const Vec3& p_W, double time_s) const {
  if (!p_W.allFinite()) return std::numeric_limits<double>::quiet_NaN();
  return distance_to_measured(newest_cloud(time_s), p_W, settings_.truth_radius_m);
}

Vec3 RecordedScene::true_normal(const Vec3& p_W, double time_s) const {
  return truth_ ? Scenario::true_normal(p_W, time_s) : Vec3::Constant(std::nan(""));
}

std::vector<PosedMesh> RecordedScene::true_meshes(double time_s) const {
  if (!truth_) return {};
  const RigidTransform X_WC = camera_at(time_s);
  std::vector<std::optional<RigidTransform>> X_WO;
  for (const std::optional<RigidTransform>& X_CO : truth_->poses(source_at(time_s)))
    X_WO.push_back(X_CO ? std::optional(X_WC * *X_CO) : std::nullopt);
  return posed_meshes(truth_->objects(), X_WO);
}

}  // namespace remote_touch
