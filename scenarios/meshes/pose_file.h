// Files of poses: one 4 x 4 matrix for each frame of a recording, or poses with time stamps.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/geometry/vector.h"
#include "scenarios/meshes/pose_path.h"

namespace remote_touch {

// Both readers accept UTF-8 with or without a byte order mark, and lines that end in LF or CR LF. Blanks and
// tabs separate the numbers. Lines that begin with # are comments. A number is a whole word in the decimal
// notation of C, whatever the locale; the lengths are in metres. Both throw InputError about "file:line"
// (about the file if it cannot be read or is longer than kMaxTextBytes).

// Reads one pose from each line that is no comment, so that line i is frame i: 16 numbers, a 4 x 4 matrix row
// by row, or 16 times nan for an unknown pose. If a comment before the first pose names the elements of the
// upper three rows, such as "# frame r00 r01 r02 tx r10 r11 r12 ty r20 r21 r22 tz error", a line has these
// columns instead; columns of other names are not used, but `frame` must count from 0. The rotation R is
// replaced by the nearest exact rotation (Higham 1986), since a file has few digits.
//
// A line is refused if it is empty; if it does not have 16 numbers; if some of them are nan, or infinite; if
// the last row differs from 0 0 0 1 by more than 1e-6; if an element of R^T R - I is above 1e-3; if R
// mirrors; or if the translation is above kMaxCoordinate_m along an axis.
std::vector<std::optional<RigidTransform>> read_pose_matrices(const std::filesystem::path& file);

// Reads a trajectory in the format of the TUM RGB-D benchmark: lines `t tx ty tz qx qy qz qw`, where t is in
// seconds of an arbitrary clock, (tx, ty, tz) is the position and q the orientation of the body in its parent
// frame. The path counts its times from the first line. Blank lines are ignored.
//
// A line is refused if it does not have 8 finite numbers; if its time is not above that of the line before,
// or is above 1e12 s; if the norm of q differs from 1 by more than 1e-2; or if the position is above
// kMaxCoordinate_m along an axis. A file without a pose is refused, too.
PosePath read_stamped_poses(const std::filesystem::path& file);

}  // namespace remote_touch
