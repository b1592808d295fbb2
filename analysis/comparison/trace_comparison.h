// Comparison of two traces: what differs, from which tick on, and in which situation it began.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/comparison/compared_columns.h"
#include "analysis/storage/result_file.h"

namespace remote_touch {

// The situation in which two runs begin to differ; the first that applies, in this order. It describes the
// two traces at the first tick at which any value differs, not the reason in the program.
enum class Cause {
  configuration,  // the experiments are not the same
  input,          // the renderer's inputs differ: time, HIP, a frame (points, time of capture), or the truth
  frame_update,   // inputs are the same, and a frame arrived in this tick, or one run did not use it
  state_transition,  // no frame came, and the proxy's state differs, or changed with this tick
  drift              // none of these: within a steady state
};
const char* name_of(Cause cause);

// The first divergent tick.
struct Divergence {
  std::size_t tick = 0;                     // the first with a value outside its tolerance
  double time_s = 0;                        // time of the baseline; NaN if it has none
  std::string quantity;                     // the column, the first in the trace's order
  double deviation = 0;                     // there, in its units; NaN for a NaN or an infinity
  std::size_t first_difference = 0;         // the first tick with any difference, inside or not; at most tick
  Cause cause = Cause::drift;               // configuration if the experiments differ, else the situation
  std::string explanation;                  // one line
  Cause situation = Cause::drift;           // situation at first_difference
  std::string observation;                  // one line: reason for the situation
  std::string frame;                        // one line: the baseline's frame there, and its next
  std::size_t first_row = 0;                // number of the first row below: first_difference - 1, or 0
  std::vector<Column> baseline, candidate;  // rows first_row .. first_difference of the common columns
};

struct TraceComparison {
  // Columns of the baseline, in its order; if the experiments differ, also those that only the candidate has.
  std::vector<ColumnComparison> columns;
  std::vector<std::string> added;        // other columns that only the candidate has: not compared
  std::optional<Divergence> divergence;  // set if a column has a row outside
  bool is_same() const;                  // false also if nothing was compared
};

// Compares the columns of two sources by name; does not search for a divergence. configuration: differences
// between the experiments of both, one text each. A column that only the baseline has is a problem of that
// column. So is one that only the candidate has, unless the experiments are the same: then a later version of
// the program has added it.
TraceComparison compare_by_name(const ColumnSource& baseline, const ColumnSource& candidate,
                                const Tolerances& tolerances, const std::vector<std::string>& configuration);

// Compares two traces by name, and finds their divergence. The running hash is not compared, because it
// follows from the others. At most two columns are in memory at a time.
TraceComparison compare_traces(const ColumnSource& baseline, const ColumnSource& candidate,
                               const Tolerances& tolerances, const std::vector<std::string>& configuration);

// Figure of the deviation between two traces over time.

// One panel for each column that differs, at most 8, in the trace's order. A panel has the decimal logarithm
// of the largest deviation in each of up to 2000 intervals of time (NaN if nothing differs), and a dot at the
// first row outside the tolerance. The caption has the first divergent tick.
Figure deviation_figure(const ColumnSource& baseline, const ColumnSource& candidate,
                        const TraceComparison& comparison);

}  // namespace remote_touch
