// Scripted device motions: their interface, and motions that need no image.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "core/points/vector.h"
#include "core/rendering/frame.h"
#include "scenarios/interface/scenario.h"

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

}  // namespace remote_touch
