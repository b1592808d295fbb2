// The log of a task's steps, from the columns of a trace.
#pragma once

#include <limits>
#include <vector>

#include "analysis/trace/trace.h"

namespace remote_touch {

// A step that has begun. Times are those of ticks; NaN for a step that had not ended at the end of the trace.
struct SequenceEntry {
  int step = 0;  // its number in the task
  double began_s = 0;
  double ended_s = std::numeric_limits<double>::quiet_NaN();
  bool missed = false;  // ended by its deadline
  // From the tool to the step's goal when it ended; NaN for a step without one. All steps that ended in the
  // same tick have the value of the first of them with a goal.
  double distance_m = std::numeric_limits<double>::quiet_NaN();
  double angle_rad = std::numeric_limits<double>::quiet_NaN();
};

// In the order of the steps; empty for a trace without a task.
std::vector<SequenceEntry> sequence_log(const Trace& trace);

}  // namespace remote_touch
