// Two traces side by side: what differs, from when on, and in what situation it began.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/comparison/column_comparison.h"
#include "analysis/comparison/column_source.h"

namespace remote_touch {

// In what situation two runs part, looked at in this order. The situation is a fact of the two traces at the
// first tick at which any value differs; what in the program brought it about is for the reader to find.
enum class Cause {
  configuration,  // the experiments are not the same
  input,          // what the renderer was given: time, HIP, a frame (points, time of capture); or the truth
  frame_update,   // inputs are the same, and a frame came in with this tick, or one did not take it
  state_transition,  // none came, and the proxy's state differs, or changed with this tick
  drift              // none of these: within a steady state
};
const char* name_of(Cause cause);

// The first divergent tick.
struct Divergence {
  std::size_t tick = 0;                     // the first with a value outside its tolerance
  double time_s = 0;                        // of the baseline; 0 where it has none
  std::string quantity;                     // the column, the first in the trace's order
  double deviation = 0;                     // there, in its units; NaN against a number: NaN
  std::size_t first_difference = 0;         // the first tick with any difference, inside or not; at most tick
  Cause cause = Cause::drift;               // configuration, where the experiments differ; else the situation
  std::string explanation;                  // one line
  Cause situation = Cause::drift;           // at the tick where they parted
  std::string observation;                  // one line: what was seen there
  std::string frame;                        // one line: the frames before and after
  std::size_t first_row = 0;                // of the rows below: parted - 1, or 0
  std::vector<Column> baseline, candidate;  // rows first_row .. parted of every column that both have
};

struct TraceComparison {
  std::vector<ColumnComparison> columns;  // of the baseline, in its order
  std::vector<std::string> added;         // columns that only the candidate has: not compared
  std::optional<Divergence> divergence;   // set when a column has a row outside
  bool is_same() const;
};

// The columns of two sources by name; no divergence is looked for.
TraceComparison compare_by_name(const ColumnSource& baseline, const ColumnSource& candidate,
                                const Tolerances& tolerances);

// configuration: differences between the experiments that made them, one text each. The running hash is not
// compared: it follows from the others. A column that only the baseline has is a problem of that column.
// Holds two columns at a time.
TraceComparison compare_traces(const ColumnSource& baseline, const ColumnSource& candidate,
                               const Tolerances& tolerances, const std::vector<std::string>& configuration);

}  // namespace remote_touch
