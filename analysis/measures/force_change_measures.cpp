#include "analysis/measures/force_change_measures.h"

#include <cmath>

#include "analysis/measures/no_value.h"
#include "analysis/trace/trace.h"

namespace remote_touch {

namespace {

// Change of a column of vectors from one tick to the next.
struct Change {
  double max = 0, squares = 0, count = 0;
  double tick = kNoValue;  // of the first change that is the maximum; NaN if all are 0

  double max_or_none() const { return count == 0 ? kNoValue : max; }
  double rms_or_none() const { return count == 0 ? kNoValue : std::sqrt(squares / count); }
};

// Collects the changes at the ticks with a frame update if at_updates, else those at the other ticks. A
// change counts if the row of this tick or of the one before is not zero.
Change change(const Trace& trace, const std::vector<Vec3>& rows, bool at_updates) {
  Change found;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (trace.frame_update(i) != at_updates || (rows[i].isZero(0) && rows[i - 1].isZero(0))) continue;
    const double squared = (rows[i] - rows[i - 1]).squaredNorm();
    if (const double size = std::sqrt(squared); size > found.max)
      found.max = size, found.tick = static_cast<double>(i);
    found.squares += squared, ++found.count;
  }
  return found;
}

}  // namespace

double max_force_jump_N(const Trace& trace) {
  return change(trace, trace.force_N, true).max_or_none();
}

double max_force_jump_tick(const Trace& trace) {
  return change(trace, trace.force_N, true).tick;
}

double rms_force_jump_N(const Trace& trace) {
  return change(trace, trace.force_N, true).rms_or_none();
}

double force_noise_N(const Trace& trace) {
  return change(trace, trace.force_N, false).rms_or_none();
}

double max_torque_jump_Nm(const Trace& trace) {
  return change(trace, trace.torque_Nm, true).max_or_none();
}

double rms_torque_jump_Nm(const Trace& trace) {
  return change(trace, trace.torque_Nm, true).rms_or_none();
}

double torque_noise_Nm(const Trace& trace) {
  return change(trace, trace.torque_Nm, false).rms_or_none();
}

}  // namespace remote_touch
