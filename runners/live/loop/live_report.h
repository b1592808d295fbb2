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
    const char* word;            // file-safe
    std::vector<double> sorted;  // seconds; only a part of them after a long run, see Samples
    std::size_t count;           // number of all times
    double least, greatest;      // least and greatest of all times
  };
  struct Count {
    const char* name;
    double value;
  };
  std::vector<Times> times;
  std::vector<Count> counts;
  // max_interval_s: longest time from tick to tick in each piece of the run; piece_s: start of the piece.
  std::vector<double> piece_s, max_interval_s;
};

LiveReport live_report(const LiveLog& log, const LiveCounts& counts);

// Rows of minimum, p50, p99, p99.9 and maximum time, then of counts.
std::string text(const LiveReport& report);

// Tables `times` and `counts` with the same numbers; distributions of the times; when the loop was late.
Figure live_figure(const LiveReport& report);

// The value below which that fraction of the sorted values lies; NaN without values.
double quantile(const std::vector<double>& sorted, double fraction);

}  // namespace remote_touch
