// Device motions that need no image, and the interface of all motions: scripts, and contacts that are
// replayed.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "core/points/vector.h"
#include "core/rendering/frames_and_outputs.h"
#include "scenarios/recordings/recording.h"
#include "scenarios/simulated/scenario.h"

namespace remote_touch {

// The depth at which the hand is meant to be, relative to the surface that the camera sees in the newest
// frame, for a motion that was planned on depth images. Depths are along the optical axis, m, positive behind
// the surface.
struct SurfacePlan {
  // True: the hand is meant to be between min_depth_m and max_depth_m. False: in front of max_depth_m.
  bool touches = false;
  double min_depth_m = 0, max_depth_m = 0;
  // The surface at a pixel is the median of the depths measured within this radius of the pixel's viewing
  // ray.
  double reach_m = 0;
  // The largest distance that the hand is meant to move from one tick to the next while the surface is at
  // rest; 0: not stated.
  double max_step_m = 0;
};

// A pure function of time.
class Trajectory {
 public:
  virtual ~Trajectory() = default;
  // Throws InputError if the motion follows the frames and one of them cannot be used.
  virtual DeviceState at(double time_s) const = 0;
  // Returns the time at which the motion ends; the device rests afterwards. 0 if it has no end.
  virtual double duration_s() const = 0;
  // The parts of the motion that begin at a set time: the press. Empty: there are none.
  virtual std::vector<Phase> phases() const { return {}; }
  // Returns nothing if the motion is not planned on depth images.
  virtual std::optional<SurfacePlan> surface_plan(double /*time_s*/) const { return {}; }
  // Returns one line about the pixels of the first frame that the motion follows, and their depth. Returns an
  // empty text if the motion is not planned on depth images.
  virtual std::string aim() const { return {}; }
  // Returns the force that an ideal renderer exerts on a hand at the position of at(), N, world frame, for a
  // motion that replays a known contact; 0 in free motion, NaN in all three coordinates where it is not
  // known. Returns nothing at any time if the motion states no force. A run with an operator, who leaves this
  // position, does not use it.
  virtual std::optional<Vec3> expected_force_N(double /*time_s*/) const { return {}; }
  // Notes on how the motion was planned.
  virtual std::vector<Note> notes() const { return {}; }
  // True if the loop of a recorded live session missed the tick at that time. The tick is then skipped.
  virtual bool is_missed(double /*time_s*/) const { return false; }
};

// Scripted motions of a device: through points and poses, onto and along a surface, and at random.

// A path of straight pieces, each with its own speed.
class PolylinePath {
 public:
  // Starts at a point, at time 0.
  explicit PolylinePath(const Vec3& start) : points_{start}, arrival_s_{0} {}
  // Continues to p at that speed; speed 0 jumps there at once.
  void go_to(const Vec3& p, double speed_m_per_s);
  // Stays for that time.
  void wait(double duration_s);

  Vec3 at(double time_s) const;  // the end point after the end
  double duration_s() const { return arrival_s_.back(); }
  const Vec3& end() const { return points_.back(); }

 private:
  std::vector<Vec3> points_;
  std::vector<double> arrival_s_;
};

// A device that visits listed points, each at its own speed.
class Waypoints final : public Trajectory {
 public:
  struct Settings {
    // Each row has x, y, z in metres and the speed in m/s of the motion to this position; speed 0 jumps. The
    // first row is the start; its speed is not used.
    std::vector<double> waypoints{0, 0.01, 0, 0};
  };

  Waypoints(const Settings& settings, const Scenario& scenario);
  DeviceState at(double time_s) const override { return {path_.at(time_s)}; }
  double duration_s() const override { return path_.duration_s(); }

 private:
  PolylinePath path_;
};

Parameters parameters(Waypoints::Settings& s);
std::string validate(const Waypoints::Settings& s);

// A device with six degrees of freedom that visits listed poses.
class Poses final : public Trajectory {
 public:
  struct Settings {
    // Each row has x, y, z in metres, the orientation of the tool as a rotation vector in degrees (axis times
    // angle, in the world frame), and the duration in s of the motion to this pose; 0 jumps. The first row is
    // the start; its duration is not used.
    std::vector<double> poses{0, 0, 0, 0, 0, 0, 0};
  };

  Poses(const Settings& settings, const Scenario& scenario);
  // The device moves at constant speed along the straight line, and turns about a fixed axis by the smaller
  // angle.
  DeviceState at(double time_s) const override;
  double duration_s() const override { return arrival_s_.back(); }

 private:
  std::vector<DeviceState> poses_;
  std::vector<double> arrival_s_;
  std::vector<Vec3> rotation_W_;  // rotation vector from the pose before to each pose
};

Parameters parameters(Poses::Settings& s);
std::string validate(const Poses::Settings& s);

// A device that waits at a point and then presses a set depth into the surface below it, 4.3.2.
class Press final : public Trajectory {
 public:
  struct Settings {
    Vec3 start_m{0, 0, 0};
    double press_at_s = 0.5;
    double depth_m = 0.03;
    SurfaceTime surface = SurfaceTime::newest_frame;
  };

  // The scenario must outlive the trajectory. Throws InputError when it is not a height field.
  Press(const Settings& settings, const Scenario& scenario);
  DeviceState at(double time_s) const override;
  double duration_s() const override { return 0; }
  std::vector<Phase> phases() const override { return {{"the press", settings_.press_at_s}}; }

 private:
  const Settings settings_;
  const Scenario& scenario_;
};

Parameters parameters(Press::Settings& s);
inline std::string validate(const Press::Settings&) {
  return {};
}

// A device that moves along a straight line over a height field, a set depth below the true surface. The HIP
// keeps its distance to every part of the surface along the line (a parallel curve, not a vertical shift). It
// lifts off over steps and comes down behind them: a frictionless proxy stays at the wall of a step as long
// as the HIP is below the step's top, so a HIP that stayed inside would only build up force. The HIP moves at
// constant speed along its own path, approaches from above and leaves upwards. The path is that over the
// surface at time 0. If the surface rises or sinks as a whole, the HIP rises and sinks with it: with the true
// surface, from which signed_distance() measures.
class FollowSurface final : public Trajectory {
 public:
  struct Settings {
    Vec3 from_m{-0.1, 0, 0};
    Vec3 to_m{0.1, 0, 0};
    double depth_m = 0.005;
    double speed_m_per_s = 0.05;
    double clearance_m = 0.02;
    double step_m = 0.02;
    double step_margin_m = 0.01;
  };

  // The scenario must outlive the motion. Throws InputError if the scenario has no surface height at the
  // start of the line, or if the surface moves otherwise than up and down as a whole.
  FollowSurface(const Settings& settings, const Scenario& scenario);
  DeviceState at(double time_s) const override;
  double duration_s() const override { return path_.duration_s(); }

 private:
  double risen_m(const Vec3& at_W, double time_s) const;  // change of the height of the surface since time 0
  void follow(const Settings& settings);                  // sets moves_

  const Scenario& scenario_;
  PolylinePath path_;
  bool moves_ = false;
};

Parameters parameters(FollowSurface::Settings& s);
std::string validate(const FollowSurface::Settings& s);

// A smooth random motion of six degrees of freedom, for stress tests. Each coordinate of the position and of
// the rotation vector is a sum of three sines with incommensurable frequencies and random phases.
class RandomMotion final : public Trajectory {
 public:
  struct Settings {
    Vec3 centre_m = Vec3::Zero();
    Vec3 extent_m{0.05, 0.05, 0.05};
    double max_rotation_deg = 45;
    double speed_m_per_s = 0.1;
    std::uint64_t seed = 1;
    double duration_s = 10;
  };

  RandomMotion(const Settings& settings, const Scenario& scenario);
  DeviceState at(double time_s) const override;
  double duration_s() const override { return settings_.duration_s; }

 private:
  static constexpr int kSines = 3;
  double coordinate(int axis, double time_s) const;  // within -1 .. 1

  const Settings settings_;
  double rate_;                                        // rate of the first sine of x, rad/s
  std::array<std::array<double, kSines>, 6> phase_{};  // phases of the position, then of the rotation vector
};

Parameters parameters(RandomMotion::Settings& s);
std::string validate(const RandomMotion::Settings& s);

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
