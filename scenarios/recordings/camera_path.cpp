#include "scenarios/recordings/camera_path.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <utility>

#include "core/points/number_columns.h"
#include "scenarios/files/input_files.h"
#include "scenarios/objects/mesh_object.h"
#include "scenarios/objects/recorded_truth.h"
#include "scenarios/recordings/recording.h"

namespace remote_touch {
namespace {

// Notes the longest time between two poses in which frames were captured, if it is long.
void note_longest_gap(const std::vector<double>& stamps_s, const RecordingIndex& recording, PoseFile& poses) {
  constexpr double kLong_s = 0.1;  // three frames of 30 Hz
  double longest_s = 0, from_s = 0;
  std::size_t frames = 0;
  for (const RecordedFrame& frame : recording.frames) {
    const double stamp_s = recording.first_stamp_s + frame.captured_s;
    const auto next = std::upper_bound(stamps_s.begin(), stamps_s.end(), stamp_s);
    if (next == stamps_s.begin() || next == stamps_s.end() || *next - *(next - 1) <= kLong_s) continue;
    ++frames;
    if (*next - *(next - 1) > longest_s) from_s = *(next - 1), longest_s = *next - from_s;
  }
  if (frames == 0) return;
  std::ostringstream text;
  text << poses.file.string() << ": " << frames << " of " << recording.frames.size()
       << " frames lie between poses that are more than " << kLong_s << " s apart, at most " << longest_s
       << " s, from " << from_s - recording.first_stamp_s << " s on: their poses are interpolated";
  poses.notes.push_back({"unusual poses", text.str()});
}

// Replaces the poses by those at the times of the frames.
void interpolate_at_frames(const RecordingIndex& recording, PoseFile& poses) {
  constexpr double kTolerance_s = 0.02;  // the tolerance of image_folders.cpp
  note_longest_gap(poses.stamps_s, recording, poses);
  const double first_s = poses.stamps_s.front(), last_s = poses.stamps_s.back();
  const PosePath path = path_of(poses, first_s);
  poses.poses.clear(), poses.stamps_s.clear();
  bool any = false;
  for (const RecordedFrame& frame : recording.frames) {
    const double stamp_s = recording.first_stamp_s + frame.captured_s;
    const bool is_known = stamp_s >= first_s - kTolerance_s && stamp_s <= last_s + kTolerance_s;
    poses.poses.push_back(is_known ? std::optional(path.at(stamp_s - first_s)) : std::nullopt);
    any |= is_known;
  }
  if (!any)
    refuse(poses.file, "has poses from ", first_s, " to ", last_s, " s, but the frames are from ",
           recording.first_stamp_s, " s on: expected stamps of one clock, in seconds");
}

PoseFile poses_of(const std::filesystem::path& file, const RecordingIndex& recording) {
  if (std::filesystem::is_directory(file)) return read_pose_folder(file, pose_files(file, recording));
  PoseFile poses = read_poses(file, PoseLines::either);
  if (!poses.stamps_s.empty() && std::isfinite(recording.first_stamp_s))
    interpolate_at_frames(recording, poses);
  if (poses.poses.size() != recording.frames.size())
    refuse(file, "has ", poses.poses.size(), " poses: expected ", recording.frames.size(),
           ", one for each frame of the recording");
  return poses;
}

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr std::size_t kComparedPixels = 2000;

// Another meaning of the poses is named if its gap is less than this share of the gap of the poses as they
// are read.
constexpr double kMuchLess = 0.5;
constexpr double kSmallGap_m = 0.005;  // errors of cameras and poses reach this size

double median(std::vector<double> values) {
  return values.empty() ? kInfinite : median_in_place(values);
}

// Returns the median, or infinity if fewer than `least` values are known.
double known_median(std::vector<double> values, double least) {
  return static_cast<double>(values.size()) >= std::max(least, 1.0) ? median(std::move(values)) : kInfinite;
}

// Distance with its unit: "31.2 mm", "400 m".
std::string length(double distance_m) {
  return distance_m < 1 ? formatted("%.3g mm", 1e3 * distance_m) : formatted("%.4g m", distance_m);
}

// The meaning with the smallest gap, and that gap. Meaning 0 is that of the poses as they are read.
struct Best {
  std::size_t meaning = 0;
  double gap_m = kInfinite;
};

// Returns no other meaning if none has much less than the gap of the poses as they are read, or all have more
// than most_m.
Best best_of(const std::vector<std::vector<double>>& gaps, double most_m) {
  Best best;
  if (gaps.empty()) return best;  // no image, or no pose in the frames that were read
  for (std::size_t i = 1; i < gaps.size(); ++i)
    if (const double gap_m = median(gaps[i]); gap_m < best.gap_m) best = {i, gap_m};
  return best.gap_m < kMuchLess * median(gaps[0]) && best.gap_m <= most_m ? best : Best{};
}

const OtherMeaning* meaning_of(std::size_t i) {
  return i == 0 ? nullptr : &other_meanings()[i - 1];
}

RigidTransform as_read(const RigidTransform& X, const RigidTransform&) {
  return X;
}

// Another meaning of the pose X of an object, or of the depths. X_WC: the pose of the camera. of: the object
// in the camera frame.
struct TruthMeaning {
  const char* text;
  std::function<RigidTransform(const RigidTransform& X, const RigidTransform& X_WC)> of = as_read;
  double depth_factor = 1;
};

// The first one is that of poses and depths as they are read.
const std::vector<TruthMeaning>& truth_meanings() {
  using X = const RigidTransform&;
  static const std::vector<TruthMeaning> kAll = [] {
    std::vector<TruthMeaning> all = {{""}};
    for (const OtherMeaning& other : other_meanings())
      all.push_back({other.text, [&other](X X_CO, X) { return other.of(X_CO); }});
    const std::vector<TruthMeaning> more = {
        {"poses object to world", [](X X_WO, X X_WC) { return X_WC.inverse() * X_WO; }},
        {"poses world to object", [](X X_OW, X X_WC) { return (X_OW * X_WC).inverse(); }},
        {"poses object to world, and the inverse poses of the camera",
         [](X X_WO, X X_CW) { return X_CW * X_WO; }},
        {"poses world to object, and the inverse poses of the camera",
         [](X X_OW, X X_CW) { return X_CW * X_OW.inverse(); }},
        {"positions 1000 times as large",
         [](X X_CO, X) { return Eigen::Translation3d(999 * X_CO.translation()) * X_CO; }},
        {"10 times the depth scale", as_read, 10},
        {"0.1 times the depth scale", as_read, 0.1},
        {"5 times the depth scale", as_read, 5},
        {"0.2 times the depth scale", as_read, 0.2},
        {"1000 times the depth scale", as_read, 1000},
        {"0.001 times the depth scale", as_read, 0.001},
    };
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }();
  return kAll;
}

std::vector<Vec3> compared_points(const PointCloud& cloud, const RigidTransform& X_CW) {
  std::vector<Vec3> points_C;
  const std::size_t step = 1 + cloud.size() / kComparedPixels;
  for (std::size_t i = 0; i < cloud.size(); i += step)
    if (cloud.is_measured(i)) points_C.push_back(X_CW * cloud.point(i));
  return points_C;
}

// Returns the distances, along the depth, of moved points from what an image shows there. depth_of: returns
// the depth of a pixel.
template <class DepthOf>
std::vector<double> gaps_of(const std::vector<Vec3>& points, const RigidTransform& X,
                            const CameraIntrinsics& camera, DepthOf&& depth_of) {
  std::vector<double> gaps;
  for (const Vec3& point : points) {
    const Vec3 p_C = X * point;
    const std::optional<std::size_t> pixel = pixel_of(camera, p_C);
    if (!pixel) continue;
    if (const double depth_m = depth_of(*pixel); std::isfinite(depth_m))
      gaps.push_back(std::abs(depth_m - p_C.z()));
  }
  return gaps;
}

}  // namespace

CameraPath::CameraPath(const RigidTransform& X_WB, const std::string& poses, PoseDirection direction,
                       const RecordingIndex& recording, const std::filesystem::path& folder)
    : X_WB_(X_WB), direction_(direction) {
  if (poses.empty()) return;
  // A path that ends in a slash has no file name, so that messages would not name the folder ".".
  poses_ = poses_of((folder / poses / "").lexically_normal().parent_path(), recording);
  for (const RecordedFrame& frame : recording.frames) time_s_.push_back(frame.captured_s);
}

std::optional<RigidTransform> CameraPath::pose_if(const OtherMeaning* meaning, std::size_t source) const {
  const std::optional<RigidTransform>& X = poses_.poses[source];
  if (!X) return {};
  const RigidTransform meant = meaning ? meaning->of(*X) : *X;
  return direction_ == PoseDirection::camera_to_world ? meant : meant.inverse();
}

RigidTransform CameraPath::pose(std::size_t source) const {
  if (!moves()) return X_WB_;
  const std::optional<RigidTransform> X_BC = pose_if(nullptr, source);
  if (!X_BC)
    refuse(poses_.file, "has no pose for frame ", source, ": expected one for every frame that is used");
  const RigidTransform X_WC = X_WB_ * *X_BC;
  if (!is_near_origin(X_WC.translation()))
    refuse(poses_.file, far_from_origin("frame " + std::to_string(source) + " has its camera"));
  return X_WC;
}

std::vector<StampedPose> CameraPath::stamped() const {
  std::vector<StampedPose> poses;
  for (std::size_t i = 0; i < poses_.poses.size(); ++i)
    if (const auto X_BC = pose_if(nullptr, i)) poses.push_back({time_s_[i], *X_BC});
  return poses;
}

std::string CameraPath::text() const {
  const std::vector<StampedPose> poses = stamped();
  if (poses.empty()) return {};
  return "camera_poses: " + poses_.file.filename().string() + ", " + motion_text(poses);
}

std::vector<Note> CameraPath::notes() const {
  std::vector<Note> notes = poses_.notes;
  const std::vector<StampedPose> poses = stamped();
  if (poses.empty()) return notes;
  for (Note& note : unusual_poses(poses_.file.filename().string(), poses, false))
    notes.push_back(std::move(note));
  return notes;
}

std::vector<std::filesystem::path> pose_files(const std::filesystem::path& folder,
                                              const RecordingIndex& recording) {
  const auto frame_of = frames_by_numbers(folder, frame_names(recording));
  std::vector<std::filesystem::path> files(recording.frames.size());
  bool any = false;
  for (const std::filesystem::path& file : files_in_order(folder, ".txt")) {
    const auto frame = frame_of.find(numbers_in_name(file.stem().string()));
    if (frame == frame_of.end()) continue;
    if (!files[frame->second].empty())
      refuse(file, "frame ", frame->second, " has another file, ", files[frame->second].string(),
             ": expected one");
    files[frame->second] = file, any = true;
  }
  if (!any)
    refuse(folder,
           "has no .txt file with the numbers of a depth image in its name: expected one pose for each, "
           "such as that of ",
           frame_names(recording).front());
  return files;
}

void PoseFit::set_anchor(std::size_t frame, const PointCloud& cloud, const RigidTransform& X_CW) {
  anchor_ = {frame, cloud.image->camera, {}};
  for (std::size_t i = 0; i < cloud.size(); ++i) anchor_.depth_m.push_back((X_CW * cloud.point(i)).z());
}

void PoseFit::add_motion(std::size_t frame, const PointCloud& cloud, const CameraPath& path) {
  constexpr std::size_t kMostApart = 10;  // frames
  constexpr double kLeastShare = 0.1, kLeftShare = 0.5;
  if (!path.moves() || !cloud.image) return;
  const RigidTransform X_CW = cloud.image->X_WC.inverse();
  if (anchor_.depth_m.empty()) return set_anchor(frame, cloud, X_CW);
  const std::vector<Vec3> points_C = compared_points(cloud, X_CW);
  const auto count = static_cast<double>(points_C.size());
  const auto depth_of = [this](std::size_t pixel) { return anchor_.depth_m[pixel]; };
  gaps_.resize(1 + other_meanings().size());
  std::size_t in_anchor = 0;
  for (std::size_t i = 0; i < gaps_.size(); ++i) {
    const auto X_BC = path.pose_if(meaning_of(i), frame), X_BA = path.pose_if(meaning_of(i), anchor_.frame);
    if (!X_BC || !X_BA) return;
    const std::vector<double> gaps = gaps_of(points_C, X_BA->inverse() * *X_BC, anchor_.camera, depth_of);
    gaps_[i].push_back(known_median(gaps, kLeastShare * count));
    if (i == 0) in_anchor = gaps.size();
  }
  still_gaps_.push_back(
      known_median(gaps_of(points_C, RigidTransform::Identity(), anchor_.camera, depth_of), 1));
  const std::size_t apart = std::max(frame, anchor_.frame) - std::min(frame, anchor_.frame);
  if (apart >= kMostApart || static_cast<double>(in_anchor) < kLeftShare * count)
    set_anchor(frame, cloud, X_CW);
}

std::vector<Note> PoseFit::motion_notes(const CameraPath& path) const {
  constexpr double kWorse = 1.25, kNoise_m = 0.001;
  if (still_gaps_.empty()) return {};
  const double gap_m = median(gaps_[0]), still_m = median(still_gaps_);
  const Best best = best_of(gaps_, kInfinite);
  const bool is_worse = gap_m > kWorse * still_m + kNoise_m;
  const bool is_beaten = gap_m > kSmallGap_m && best.meaning > 0;
  if (!is_worse && !is_beaten) return {};
  std::string text =
      path.file().file.filename().string() + ": " +
      (std::isfinite(gap_m) ? "with these poses the frames differ by " + length(gap_m)
                            : std::string("with these poses the frames show different places")) +
      " (median of the depth), without poses by " + length(still_m);
  if (best.meaning > 0 && best.gap_m <= still_m)
    text += std::string(", with ") + meaning_of(best.meaning)->text + " by " + length(best.gap_m) +
            (best.meaning == 1 ? ": scenario.pose_direction may be the other one"
                               : ": this may be what the file has");
  else
    text += ": the poses may be those of other frames, or in another order";
  return {{"poses do not fit", text}};
}

void PoseFit::add_truth(std::size_t frame, const PointCloud& cloud, const RecordedTruth& truth) {
  constexpr double kLeastShare = 0.05;
  if (!cloud.image) return;
  const CameraIntrinsics& camera = cloud.image->camera;
  const RigidTransform &X_WC = cloud.image->X_WC, X_CW = X_WC.inverse();
  objects_.resize(truth.objects().size());
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const std::optional<RigidTransform>& X_CO = truth.poses(frame)[i];
    if (!X_CO) continue;
    ObjectFit& fit = objects_[i];
    fit.gaps.resize(truth_meanings().size());
    ++fit.frames;
    fit.frames_in_image += count_in_image(truth.samples()[i], *X_CO, camera) > 0 ? 1 : 0;
    for (std::size_t m = 0; m < fit.gaps.size(); ++m) {
      const TruthMeaning& meaning = truth_meanings()[m];
      const RigidTransform X = meaning.of(*X_CO, X_WC);
      const auto depth_of = [&](std::size_t pixel) {
        return meaning.depth_factor * (X_CW * cloud.point(pixel)).z();
      };
      std::vector<Vec3> facing_O;
      for (const SampledPoint& sample : truth.samples()[i])
        if ((X.linear() * sample.normal).dot(X * sample.point) < 0) facing_O.push_back(sample.point);
      const std::vector<double> gaps = gaps_of(facing_O, X, camera, depth_of);
      fit.gaps[m].push_back(known_median(gaps, kLeastShare * static_cast<double>(facing_O.size())));
      if (m > 0) continue;
      fit.measured += gaps.size();
      fit.near += static_cast<std::size_t>(
          std::count_if(gaps.begin(), gaps.end(), [&](double gap) { return gap <= truth.reach_m(); }));
    }
  }
}

std::vector<Note> PoseFit::truth_notes(const RecordedTruth& truth) const {
  constexpr double kLeastShareNear = 0.1;
  std::vector<Note> notes;
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const ObjectFit& fit = objects_[i];
    if (fit.frames == 0) continue;
    const double gap_m = median(fit.gaps[0]);
    const Best best = best_of(fit.gaps, truth.reach_m());
    const bool is_elsewhere =
        static_cast<double>(fit.near) <= kLeastShareNear * static_cast<double>(fit.measured);
    const bool is_beaten = gap_m > kSmallGap_m && best.meaning > 0;
    if (!is_elsewhere && !is_beaten) continue;
    std::string text = "the true object " + truth.objects()[i].name;
    if (fit.frames_in_image == 0)
      text += " is outside the image in all " + std::to_string(fit.frames) + " frames that were read";
    else if (std::isfinite(gap_m))
      text += " is " + length(gap_m) + " from what the camera measured there (median of the depth)";
    else
      text += " is where the camera measured nothing";
    if (best.meaning > 0)
      text += std::string("; with ") + truth_meanings()[best.meaning].text + " it is " + length(best.gap_m) +
              " from it: expected object frame to camera frame, metres";
    notes.push_back({"truth elsewhere", text});
  }
  return notes;
}

PoseFit::Cause PoseFit::cause(const RecordedTruth& truth) const {
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const Best best = best_of(objects_[i].gaps, truth.reach_m());
    const TruthMeaning& meaning = truth_meanings()[best.meaning];
    if (best.meaning > 0)
      return {std::string("; with ") + meaning.text + ", " + truth.objects()[i].name + " is " +
                  length(best.gap_m) + " from what the camera measured",
              meaning.depth_factor != 1};
  }
  return {};
}

}  // namespace remote_touch
