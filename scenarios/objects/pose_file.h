// Files of poses: one pose for each frame of a recording, or poses with time stamps.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/points/vector.h"
#include "scenarios/objects/mesh_object.h"
#include "scenarios/scene/scenario.h"

namespace remote_touch {

struct PoseFile {
  std::filesystem::path file;
  // One for each line that is no comment, or for each file of a folder; nothing: unknown.
  std::vector<std::optional<RigidTransform>> poses;
  std::vector<double> stamps_s;  // one for each pose, increasing; empty: the poses are those of frames
  bool has_unnamed_quaternions = false;  // no header states the order of the numbers of a quaternion
  std::vector<Note> notes;
};

// Direction of the poses of a camera: camera to world (base) frame, or the inverse.
enum class PoseDirection { camera_to_world, world_to_camera };

enum class PoseLines { of_frames, stamped, either };

// Reads UTF-8 with or without a byte order mark, and lines that end in LF or CR LF. Blanks and tabs separate
// the numbers. Lines that begin with # are comments. A pose is that of a body in its parent frame: x, y and z
// of its origin in metres, and a rotation.
//
// If a comment before the first pose, or the first line, names columns, they are read by these names: `tx ty
// tz` (or x, px), with `qx qy qz qw` or the rows `r00 r01 r02 r10 ... r22` of R, and `t` (or time, timestamp,
// stamp) of stamped poses or `frame`, which counts from 0. Names may end in a unit, "tx_mm" or "t [ms]", see
// input_files.h; columns of other names are not used. Without such names a line of 16 numbers is a 4 x 4
// matrix row by row, and a line of 8 numbers is stamped: `t tx ty tz qx qy qz qw`. A pose whose numbers are
// all nan or infinite is unknown, unless it is stamped. R is replaced by the nearest exact rotation (Higham
// 1986), since a file has few digits, and a quaternion is normalised. If two stamps are equal, the first pose
// is kept, and a note reports it.
//
// Throws InputError about "file:line" in these cases (about the file if it cannot be read or is longer than
// kMaxTextBytes): the names are those of three or more elements of a pose, but not of a whole pose; another
// number of words; a word that is no number; a number that is not finite; an empty line before a pose that
// is not stamped; the last row of a matrix differs from 0 0 0 1 by more than 1e-6; an element of R^T R - I
// is above 1e-3; R mirrors; the norm of a quaternion differs from 1 by more than 1e-2; a translation is above
// kMaxCoordinate_m along an axis; stamps decrease or are above 1e12 s; there are stamps, or none, although
// `expected` says otherwise; a stamped file has no pose.
PoseFile read_poses(const std::filesystem::path& file, PoseLines expected);

// Reads one pose from each file, 4 x 4 numbers in as many lines as it has. Throws as above.
PoseFile read_pose_folder(const std::filesystem::path& folder,
                          const std::vector<std::filesystem::path>& files);

// Returns the pose of a matrix whose upper three rows are these, or nothing if none of its numbers is finite.
// Throws InputError about `where` as read_poses() does.
std::optional<RigidTransform> pose_of_rows(const std::string& where, const std::array<double, 12>& rows);

// Returns the poses at their times after origin_s. Pre: stamped.
PosePath path_of(const PoseFile& poses, double origin_s);

// Returns the time 0 of each of several stamped files. Files of several poses whose times overlap, each with
// another or over others, have one clock, whose 0 is the earliest stamp of all. Otherwise each file counts
// from its first stamp, and a note reports that.
std::vector<double> origins_of_clocks(std::span<const PoseFile* const> files, std::vector<Note>& notes);

// Returns "70 poses over 2.3 s at 30 Hz, 0.412 m long, at most 0.9 m/s". Pre: one pose or more.
std::string motion_text(std::span<const StampedPose> poses);

// Returns notes on poses that are improbable, with their likely cause: faster than 10 m/s, farther than 10 m
// from the origin of the parent frame, less than one or more than 1000 in a second, and, for quaternions
// whose order is not stated, a half turn about x, which is no turn if qw comes first.
std::vector<Note> unusual_poses(const std::string& subject, std::span<const StampedPose> poses,
                                bool has_unnamed_quaternions);

// Another meaning that the numbers of a pose may have, and the pose that they would then be.
struct OtherMeaning {
  const char* text;  // "with the inverse poses"
  RigidTransform (*of)(const RigidTransform& X);
};
// The first one is the inverse.
std::span<const OtherMeaning> other_meanings();

}  // namespace remote_touch
