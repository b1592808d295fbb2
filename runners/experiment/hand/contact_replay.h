// A device that replays a contact whose force is known, so that the force of a renderer can be compared with
// it. After E. Ruffaldi, D. Morris, T. Edmunds, F. Barbagli and D. K. Pai, "Standardized evaluation of haptic
// rendering systems", Haptics Symposium 2006: the position p of a contact and its force F are known, and the
// HIP is where a spring of stiffness k would exert this force,
//
//   HIP = p + r n - F / k.
//
// F is the force on the hand, n the outward unit normal of the true surface at p, and r the distance of the
// HIP from the surface at which the force of the renderer under test begins. The paper has r = 0: its
// renderers hold a point on the surface. So do god-object and surfels here. r is 0 for the proxy of chapter 4
// too: its ball is held r_c above the surface, but its spring (4.16) has the rest length r_c. r is
// contact_radius_m for the penalty force, and the height of the surface over the points for implicit-surface.
//
// The expected force is exact for a renderer without friction whose force is k (r - d) n, d being the
// distance of the HIP from the true surface and n the normal there, if F acts along n and the surface is
// smooth: F / k is then less than the radius of curvature of its convex parts. At an edge the expected force
// turns from one row to the next. In free motion F = 0, and the HIP is r farther from the surface than p.
//
// The contact comes from a file (read_force_trace()), or it is generated: a path over the true surface of the
// scenario with a stated force. In both cases it is stored as rows of time, HIP and force; between two rows
// HIP and force are linear in time. Before the first row and after the last one the device rests. A file
// should begin in free motion, with the HIP farther from the surface than the contact radius of the renderer:
// a proxy that starts in contact may be on the wrong side.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "core/points/vector.h"
#include "runners/experiment/hand/trajectory.h"
#include "scenarios/recordings/recording.h"
#include "scenarios/scene/scenario.h"

namespace remote_touch {

// Files of measured contacts: time, position of the contact and force, sample by sample.
//
// .csv: the first line names the columns, separated by commas. .traj: columns separated by blanks or tabs and
// no names; the caller states them. Blank lines, and lines that begin with # or %, are skipped in both.
//
// Names of columns, in small or capital letters: time or t; x y z or px py pz, the position of the contact;
// fx fy fz, the force. A name may end in its unit: _s or _ms, _m or _mm, _N. Without a unit the numbers are
// seconds, metres and newtons. Columns of other names, such as torques and orientations, are not used.

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

class ContactReplay final : public Trajectory {
 public:
  struct Settings {
    // k, and r of the renderer under test. If they are not those of the renderer, the expected force is
    // wrong.
    double stiffness_N_per_m = 600;
    double onset_distance_m = 0;

    // --- a contact from a file ---
    std::string file;  // empty: the contact is generated
    // The columns of a .traj file. The pages of the paper state stiffness in N/mm, hence millimetres.
    std::string columns = "time_s x_mm y_mm z_mm fx_N fy_N fz_N";
    double start_s = 0;  // part of the file that is left out at its begin
    // The position of the contact in the world frame is offset_m + rotation(rotation_deg) (scale x). Forces
    // are rotated only.
    double scale = 1;
    Vec3 rotation_deg{0, 0, 0};
    Vec3 offset_m{0, 0, 0};
    bool force_on_object = false;  // the file has the force on the object, which is minus that on the hand
    double contact_force_N = 0;    // smaller forces are noise of the sensor in free motion, and are set to 0

    // --- a generated contact ---
    // The contact moves over the points of the surface that are nearest to the points of a straight line.
    // Over a height field the line is first moved vertically onto it, and its heights are not used.
    Vec3 from_m{-0.05, 0, 0};
    Vec3 to_m{0.05, 0, 0};
    double speed_m_per_s = 0.05;  // along the line, and in the approach and retreat
    double clearance_m = 0.02;    // distance from contact at the start and at the end
    double ramp_s = 0.2;          // the force rises from 0, and falls to 0, linearly in this time
    // The force along the outward normal while the contact moves: a cosine that begins at its minimum.
    double min_force_N = 1;
    double max_force_N = 3;
    double force_period_s = 1;
  };

  // Throws InputError if the file cannot be read, has no force or lasts longer than 10000 s, if no surface is
  // known along the path, or if the device would be too far from the origin.
  ContactReplay(const Settings& settings, const Scenario& scenario);
  DeviceState at(double time_s) const override { return {row_at(time_s).hip_W}; }
  double duration_s() const override { return rows_.back().time_s; }
  std::optional<Vec3> expected_force_N(double time_s) const override { return row_at(time_s).force_N; }
  // The span from the first row with a force to the last one.
  std::vector<Phase> phases() const override;
  // A note on the columns of the file that are not used.
  std::vector<Note> notes() const override { return notes_; }

  struct Row {
    double time_s = 0;
    Vec3 hip_W = Vec3::Zero();
    Vec3 force_N = Vec3::Zero();
  };

 private:
  Row row_at(double time_s) const;

  std::vector<Row> rows_;  // two or more; the first is at time 0
  std::vector<Note> notes_;
};

Parameters parameters(ContactReplay::Settings& s);
std::string validate(const ContactReplay::Settings& s);
// The file, if there is one.
std::vector<InputPart> input_files(const ContactReplay::Settings& s);

}  // namespace remote_touch
