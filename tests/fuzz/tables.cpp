// Tables of numbers in text files: poses, and contacts with their forces.
#include <algorithm>

#include "runners/experiment/hand/trajectory.h"
#include "scenarios/objects/mesh_object.h"
#include "tests/fuzz/shared/fuzz_target.h"

namespace remote_touch::fuzz::tables {
namespace {

void read_pose_lines(std::string_view bytes) {
  const auto file = scratch_file("poses.txt", bytes);
  accepts(bytes, [&] {
    const PoseFile found = read_poses(file, PoseLines::either);
    require(found.stamps_s.empty() || found.stamps_s.size() == found.poses.size(), "each pose has a stamp");
    require(std::is_sorted(found.stamps_s.begin(), found.stamps_s.end()), "stamps increase");
    for (const auto& pose : found.poses) require(!pose || pose->matrix().allFinite(), "a pose is finite");
  });
}

void read_forces(std::string_view bytes) {
  for (const char* name : {"contact.csv", "contact.traj"}) {
    const auto file = scratch_file(name, bytes);
    accepts(bytes, [&] {
      const ForceTrace trace = read_force_trace(file, "t x_mm y_mm z_mm fx fy fz");
      require(trace.rows.size() >= 2, "a contact has a duration");
      for (const ForceTraceRow& row : trace.rows)
        require(row.contact_m.allFinite() && row.force_N.allFinite(), "contacts and forces are finite");
    });
  }
}

const Registered of_poses("pose_file", read_pose_lines), of_forces("force_trace", read_forces);

}  // namespace
}  // namespace remote_touch::fuzz::tables
