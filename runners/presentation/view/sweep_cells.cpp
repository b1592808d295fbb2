#include "runners/presentation/view/sweep_cells.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

namespace {

class FailedCells {
 public:
  FailedCells(const SweepResult& result, const std::vector<double>& measure, double threshold)
      : result_(result), measure_(measure), threshold_(threshold) {}

  bool has_failed_run(std::size_t cell) const { return counts_of(cell).events > 0; }
  bool at_limit(std::size_t cell) const {
    if (!mostly_failed(cell)) return false;
    for (std::size_t axis = 0; axis < result_.axes.size(); ++axis)
      for (const int way : {-1, 1})
        if (passes_next_to(cell, axis, way)) return true;
    return false;
  }
  std::size_t failed_run(std::size_t cell) const {
    int replicate = 0;
    while (!(measure_[result_.run(cell, replicate)] > threshold_)) ++replicate;
    return result_.run(cell, replicate);
  }

 private:
  EventCounts counts_of(std::size_t cell) const { return event_counts(result_, measure_, cell, threshold_); }
  bool mostly_failed(std::size_t cell) const {
    const EventCounts counts = counts_of(cell);
    return counts.events > counts.without + counts.unknown;
  }
  bool passes_next_to(std::size_t cell, std::size_t axis, int way) const {
    std::vector<std::size_t> indices = result_.axis_indices(cell);
    const std::size_t last = result_.axes[axis].length() - 1;
    while (way < 0 ? indices[axis] > 0 : indices[axis] < last) {
      indices[axis] += static_cast<std::size_t>(way);
      const std::size_t next = result_.cell_at(indices);
      if (counts_of(next).runs() > 0) return !mostly_failed(next);
    }
    return false;
  }

  const SweepResult& result_;
  const std::vector<double>& measure_;
  const double threshold_;
};

std::vector<std::size_t> spread(const std::vector<std::size_t>& all, std::size_t max) {
  if (all.size() <= max) return all;
  std::vector<std::size_t> some;
  for (std::size_t i = 0; i < max; ++i)
    some.push_back(all[i * (all.size() - 1) / std::max<std::size_t>(max - 1, 1)]);
  return some;
}

std::vector<std::size_t> extremes(const SweepResult& result, const std::vector<double>& measure) {
  std::vector<std::size_t> done = result.runs_in(RunState::done);
  std::erase_if(done, [&](std::size_t run) { return std::isnan(measure[run]); });
  if (done.empty()) return spread(result.runs_in(RunState::done), 1);
  const auto less = [&](std::size_t a, std::size_t b) { return measure[a] < measure[b]; };
  const auto [low, high] = std::minmax_element(done.begin(), done.end(), less);
  std::vector<std::size_t> both{std::min(*low, *high), std::max(*low, *high)};
  both.erase(std::unique(both.begin(), both.end()), both.end());
  return both;
}

}  // namespace

std::vector<std::size_t> default_runs(const SweepResult& result, const std::vector<double>& measure,
                                      double threshold, std::size_t max) {
  const FailedCells failed(result, measure, threshold);
  std::vector<std::size_t> at_limit, any;
  for (std::size_t cell = 0; cell < result.cell_count(); ++cell) {
    if (!failed.has_failed_run(cell)) continue;
    any.push_back(failed.failed_run(cell));
    if (failed.at_limit(cell)) at_limit.push_back(failed.failed_run(cell));
  }
  if (any.empty()) return spread(extremes(result, measure), max);
  return spread(at_limit.empty() ? any : at_limit, max);
}

}  // namespace remote_touch
