#include "scenarios/recordings/camera_path.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "core/geometry/point_cloud.h"
#include "scenarios/recordings/folder_files.h"
#include "scenarios/text_files/file_order.h"
#include "scenarios/text_files/refuse.h"

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
  constexpr double kTolerance_s = 0.02;  // the tolerance of tum_layout.cpp
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

}  // namespace remote_touch
