// Timing of a live run: a text table and a figure.
#pragma once

#include <string>
#include <vector>

#include "analysis/figures/figure.h"
#include "runners/live/loop/live_log.h"

namespace remote_touch {

struct LiveReport {
  struct Times {
    const char* name;
    const char* key;             // file-safe
    std::vector<double> sorted;  // seconds; only a part of them after a long run, see Samples
    std::size_t count;           // number of all times
    double least, greatest;      // least and greatest of all times
  };
  struct Count {
    const char* name;
    double value;  // NaN if there was nothing to measure
  };
  std::vector<Times> times;
  std::vector<Count> counts;
  // max_interval_s: longest time from tick to tick in each piece of the run; piece_s: start of the piece.
  std::vector<double> piece_s, max_interval_s;
};

LiveReport live_report(const LiveLog& log, const LiveCounts& counts);

// Returns a text table: least time, p50, p99, p99.9 and greatest time in each row, then the counts. A
// number that could not be measured is "none".
std::string text(const LiveReport& report);

// Returns the tables `times` and `counts` with the same numbers, the distributions of the times, and a curve
// of the longest time from tick to tick over the run.
Figure live_figure(const LiveReport& report);

// Returns the value at this fraction of the sorted values, by the nearest index; NaN if there are no values.
double quantile(const std::vector<double>& sorted, double fraction);

}  // namespace remote_touch
