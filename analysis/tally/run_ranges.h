// A set of runs, as ranges of their numbers.
#pragma once

#include <cstdint>
#include <vector>

namespace remote_touch {

struct RunRange {
  std::uint64_t first = 0, end = 0;  // first .. end - 1

  bool operator==(const RunRange&) const = default;
};

class RunRanges {
 public:
  // Adds the runs first .. end - 1. pre: the set has none of them.
  void add(RunRange range);
  // pre: the sets have no run in common.
  void add(const RunRanges& other);

  // Increasing; between two ranges is at least one run that the set does not have.
  const std::vector<RunRange>& ranges() const { return ranges_; }
  std::uint64_t count() const;  // number of runs
  // Number of runs in this range.
  std::uint64_t count_in(RunRange range) const;
  // Returns the first range of runs in both sets; an empty one if there is none.
  RunRange first_common(const RunRanges& other) const;
  // Returns the runs of first .. end - 1 that the set does not have.
  RunRanges missing_in(RunRange range) const;

  bool operator==(const RunRanges&) const = default;

 private:
  std::vector<RunRange> ranges_;
};

}  // namespace remote_touch
