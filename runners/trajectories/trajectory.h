// The interface of every scripted device motion.
#pragma once

#include <vector>

#include "core/rendering/frame.h"
#include "scenarios/interface/note.h"

namespace remote_touch {

// A pure function of time.
class Trajectory {
 public:
  virtual ~Trajectory() = default;
  virtual DeviceState at(double time_s) const = 0;
  // When the motion ends; the device rests afterwards. 0 if it has no end.
  virtual double duration_s() const = 0;
  // The parts of the motion that begin at a set time: the press. Empty: there are none.
  virtual std::vector<Phase> phases() const { return {}; }
  // Of a recorded live session: its loop missed the tick at that time, which is then skipped.
  virtual bool is_missed(double /*time_s*/) const { return false; }
};

}  // namespace remote_touch
