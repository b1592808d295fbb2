// Files of measured contacts: time, position of the contact and force, sample by sample.
//
// .csv: the first line names the columns, separated by commas. .traj: columns separated by blanks or tabs and
// no names; the caller states them. Blank lines, and lines that begin with # or %, are skipped in both.
//
// Names of columns, in small or capital letters: time or t; x y z or px py pz, the position of the contact;
// fx fy fz, the force. A name may end in its unit: _s or _ms, _m or _mm, _N. Without a unit the numbers are
// seconds, metres and newtons. Columns of other names, such as torques and orientations, are not used.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/geometry/vector.h"

namespace remote_touch {

struct ForceTraceRow {
  double time_s = 0;
  Vec3 contact_m = Vec3::Zero();  // position of the contact, in the frame of the file
  Vec3 force_N = Vec3::Zero();    // force as the file has it: its sign and its frame
};

struct ForceTrace {
  std::vector<ForceTraceRow> rows;  // two or more, in order of time
  std::vector<std::string> unused;  // names of the columns that are not used; "column 9" if it has none
  bool states_length = false;       // the name of the column of x states its unit
};

// traj_columns: the names of the columns of a .traj file, in their order, separated by blanks. Further
// columns of the file are not used. Throws InputError, with the file and the line, if the file cannot be read
// or has another ending, if a column is missing or named twice, if a value is not a finite number, if a time
// is not later than that of the row before, or if a position is more than 100 m from the origin along an axis
// (are these millimetres?).
ForceTrace read_force_trace(const std::filesystem::path& file, const std::string& traj_columns);

}  // namespace remote_touch
