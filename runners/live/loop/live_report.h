// How punctual a live run was: a table to be read, and a figure.
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
    std::vector<double> sorted;  // seconds
  };
  struct Count {
    const char* name;
    double value;
  };
  std::vector<Times> times;
  std::vector<Count> counts;
  // Longest time from tick to tick in each of up to kMaxPieces pieces of the run, at its beginning.
  std::vector<double> piece_s, max_interval_s;

  static constexpr std::size_t kMaxPieces = 2000;
};

LiveReport live_report(const LiveLog& log, const LiveCounts& counts);

// Rows of least, p50, p99, p99.9 and largest time, then of counts.
std::string text(const LiveReport& report);

// Tables `times` and `counts` with the same numbers; how often what takes how long; when the loop was late.
Figure live_figure(const LiveReport& report);

// Of sorted values, the one below which that share of them lies; NaN of none.
double quantile(const std::vector<double>& sorted, double fraction);

}  // namespace remote_touch
