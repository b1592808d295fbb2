#include "analysis/tally/run_ranges.h"

#include <algorithm>
#include <iterator>

namespace remote_touch {

namespace {

// Returns an iterator to the first range that ends after the run.
auto first_after(const std::vector<RunRange>& ranges, std::uint64_t run) {
  return std::upper_bound(ranges.begin(), ranges.end(), run,
                          [](std::uint64_t number, const RunRange& range) { return number < range.end; });
}

}  // namespace

void RunRanges::add(RunRange range) {
  if (range.first == range.end) return;
  auto next = ranges_.begin() + (first_after(ranges_, range.first) - ranges_.cbegin());
  const bool joins_next = next != ranges_.end() && next->first == range.end;
  const bool joins_last = next != ranges_.begin() && std::prev(next)->end == range.first;
  if (joins_next && joins_last) {
    std::prev(next)->end = next->end;
    ranges_.erase(next);
  } else if (joins_next) {
    next->first = range.first;
  } else if (joins_last) {
    std::prev(next)->end = range.end;
  } else {
    ranges_.insert(next, range);
  }
}

void RunRanges::add(const RunRanges& other) {
  std::vector<RunRange> all;
  std::merge(ranges_.begin(), ranges_.end(), other.ranges_.begin(), other.ranges_.end(),
             std::back_inserter(all), [](const RunRange& a, const RunRange& b) { return a.first < b.first; });
  ranges_.clear();
  for (const RunRange& range : all)
    if (!ranges_.empty() && ranges_.back().end == range.first)
      ranges_.back().end = range.end;
    else
      ranges_.push_back(range);
}

std::uint64_t RunRanges::count() const {
  std::uint64_t count = 0;
  for (const RunRange& range : ranges_) count += range.end - range.first;
  return count;
}

std::uint64_t RunRanges::count_in(RunRange range) const {
  std::uint64_t count = 0;
  for (auto at = first_after(ranges_, range.first); at != ranges_.end() && at->first < range.end; ++at)
    count += std::min(at->end, range.end) - std::max(at->first, range.first);
  return count;
}

RunRange RunRanges::first_common(const RunRanges& other) const {
  for (auto a = ranges_.begin(), b = other.ranges_.begin(); a != ranges_.end() && b != other.ranges_.end();) {
    const RunRange common{std::max(a->first, b->first), std::min(a->end, b->end)};
    if (common.first < common.end) return common;
    ++(a->end <= b->end ? a : b);
  }
  return {};
}

RunRanges RunRanges::missing_in(RunRange range) const {
  RunRanges missing;
  std::uint64_t next = range.first;
  for (auto at = first_after(ranges_, range.first); at != ranges_.end() && at->first < range.end; ++at) {
    if (at->first > next) missing.ranges_.push_back({next, at->first});
    next = at->end;
  }
  if (next < range.end) missing.ranges_.push_back({next, range.end});
  return missing;
}

}  // namespace remote_touch
