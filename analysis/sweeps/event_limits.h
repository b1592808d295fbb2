// Finds the value on an axis of a sweep at which an event has a given probability, for example 0.5.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "analysis/sweeps/sweep_result.h"

namespace remote_touch {

// The event happens in a run if its measure is above the threshold.
struct LimitQuestion {
  std::string measure;
  double threshold = 0.5;
  std::size_t along = 0;  // number of an axis; pre: its values are numbers
  double level = 0.5;     // probability of the event at the limit, in (0, 1)
};

struct EventLimits {
  Table table;
  bool rises = true;  // true: the event becomes more probable along the axis
};

// The table has a row for each combination of the other axes: their values, `limit`, `limit_low`,
// `limit_high`, `at_least` and `at_most` in the unit of the axis, `place` and `runs`, and `noted_runs` if the
// sweep has stored the notes on its runs.
//
// At each value of the axis the share of finished runs with the event has a 95 % Wilson interval. The curve
// that is nearest to the shares and only falls, or only rises, along the axis crosses the level at `limit`,
// with linear interpolation (isotonic_regression.h). The curves of the two ends of the intervals cross it at
// limit_low and limit_high. They are NaN if the curve does not cross the level between values of the axis
// that have finished runs. `place` then states on which side of the axis the limit is or, if the value at
// that end of the axis has no finished runs, on which side of the values that have some.
//
// Interpolation can make an interval narrower than the distance between two values of the axis. The limit is
// at least at `at_least` and at most at `at_most` without it: these are the last value at which the event is
// clearly less probable than the level and the first at which it is clearly more probable, or the other way
// round if the event becomes less probable along the axis. NaN if there is no such value.
//
// All rows have one direction: that in which the shares change over the whole sweep. A row that clearly
// changes the other way has no limit, and `place` says so: at one end of the axis its interval is on the
// wrong side of that at the other end. Values without a finished run are left out. A run whose measure is NaN
// counts as a run without the event, as in tally().
EventLimits event_limits(const SweepResult& result, const LimitQuestion& question);

// The counts of each cell, for a sweep that does not keep its runs.
struct CellCounts {
  std::function<Tally(std::size_t cell)> events;             // counts the finished runs
  std::function<std::int32_t(std::size_t cell)> noted = {};  // finished runs with a note; empty: not known
};
// The same with these counts. Only the axes of the outline are used.
EventLimits event_limits(const SweepResult& outline, const CellCounts& cells, const LimitQuestion& question);

}  // namespace remote_touch
