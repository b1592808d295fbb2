// The interface of every scripted device motion.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/rendering/frame.h"
#include "scenarios/scene/scenario.h"

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

}  // namespace remote_touch
