// The log of a task's steps, from the columns of a trace.
#pragma once

#include <limits>
#include <vector>

namespace remote_touch {

struct Trace;

// A step that has begun. Its times are times of ticks. ended_s is NaN if the step had not ended at the end of
// the trace.
struct SequenceEntry {
  int step = 0;  // its number in the task
  double began_s = 0;
  double ended_s = std::numeric_limits<double>::quiet_NaN();
  bool missed = false;  // true if the deadline ended the step
  // Distance and angle from the tool to the step's goal when the step ended; NaN for a step without a goal.
  // All steps that ended in the same tick have the values of the first of them with a goal.
  double distance_m = std::numeric_limits<double>::quiet_NaN();
  double angle_rad = std::numeric_limits<double>::quiet_NaN();
};

// Returns the entries in the order of the steps; empty for a trace without a task.
std::vector<SequenceEntry> sequence_log(const Trace& trace);

}  // namespace remote_touch
