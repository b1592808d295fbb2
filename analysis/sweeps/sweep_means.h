// Means of the measures of a sweep, differences between the values of one of its axes, and the value on an
// axis at which an event has a given probability, with 95 % intervals: the rows of tables of estimates.
// Beside them, the runs that a refinement of the sweep adds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/sweeps/sweep_result.h"
#include "analysis/sweeps/sweep_tally.h"
#include "analysis/trace/curve_fits.h"
#include "analysis/trace/interval_estimates.h"

namespace remote_touch {

// Returns a table with a row for each combination of the axes `by` (increasing): their values, and the
// columns of add_estimates(). Runs that are not finished are left out. Runs that share random numbers count
// as one, with their mean (clusters_of()); fixed cells count once. An event (is_event()) has the fraction of
// estimated_fraction(), another measure the mean of estimated_mean() with a stratum for each noise cell, or
// one stratum if runs are taken together by replicate. streams: of the sweep's cells. pre: the result is
// whole.
Table sweep_means(const SweepResult& result, const std::string& measure, const std::vector<std::size_t>& by,
                  const CellStreams& streams);
// The same without a correction for skewness: a tally has no third moments. pre: no row pools cells that
// share random numbers (CellStreams::are_independent()), because a tally does not know which of its runs do.
Table sweep_means(const SweepTally& tally, const std::string& measure, const std::vector<std::size_t>& by,
                  const CellStreams& streams);

// Returns a table of the differences of the measure at each value of the axis `between` from that at its
// first value. It has a row for each such value and each combination of the axes `by`: the values, and the
// columns of add_estimates() with p. A pair is two finished runs of one replicate whose cells differ on the
// axis `between` only; with common noise they differ in nothing else. Pairs that share random numbers count
// as one. An event is compared by estimated_event_difference(), another measure by estimated_difference(). A
// row whose cells are all fixed is exact and has no p. pre: `by` does not contain `between`.
Table sweep_differences(const SweepResult& result, const std::string& measure, std::size_t between,
                        const std::vector<std::size_t>& by, const CellStreams& streams);

inline constexpr const char* kRunsMeaning =
    "number of independent runs; those that share random numbers count as one";
// The meaning of the columns of a table of estimates.
struct EstimateTexts {
  std::string unit;
  std::string value;       // long name of the values
  std::string runs;        // long name of the counts
  bool has_tests = false;  // true: there are the columns p and adjusted_p
};
// Adds the columns value, low, high, runs (clusters), unknown, noted_runs if `noted` is not empty, method,
// p and adjusted_p if there are tests, and note. A column whose name an axis has is called NAME_of_answer.
// adjusted_p: after Holm, over the rows of the table.
void add_estimates(Table& table, const std::vector<Estimate>& estimates, const EstimateTexts& texts,
                   const std::vector<std::int64_t>& noted);
// Returns the name of a further column of an answer: `name`, or NAME_of_answer if an axis has it.
std::string name_beside(const Table& table, const std::string& name);
// The number of finished runs with a note in each group; empty if the result has no notes.
std::vector<std::int64_t> noted_runs(const SweepResult& result, const std::vector<CellGroup>& groups);

// Adjusts the p of all tables together, as one family of Holm's, and returns a sentence about it: the number
// of tests, and how many pairs are needed if that many can never reach 0.05. Empty without a test.
std::string adjust_together(std::vector<Table>& tables);

// Adds a note on unknown runs to an estimate: for an event if they are more than 5 % of `runs`, for a mean
// always, because it leaves them out.
void note_unknown(Estimate& estimate, std::int64_t runs, bool is_event, const std::string& what = "runs");
// Adds a note if the clusters are fewer than the runs. what: "runs" or "pairs".
void note_shared(Estimate& estimate, std::int64_t runs, std::int64_t clusters, const char* what);

// Finds the value on an axis of a sweep at which an event has a given probability, for example 0.5.

// The event happens in a run if its measure is above the threshold; it is unknown if the measure is NaN.
struct LimitQuestion {
  std::string measure;
  double threshold = 0.5;
  std::size_t along = 0;  // number of an axis; pre: its values are numbers
  double level = 0.5;     // probability of the event at the limit, in (0, 1)
  // True: the event becomes more probable along the axis; false: less. Empty: the runs show it, or nothing
  // does.
  std::optional<bool> rises = {};
};

struct EventLimits {
  Table table;
  std::optional<bool> rises;  // the stated direction, or the one that the runs show; empty: none
};

// The table has a row for each combination of the other axes: their values, the columns of add_estimates() in
// the unit of the axis, and `place`. value, low and high are those of estimated_limit(). A fixed cell counts
// as one run, which is certain.
//
// All rows have one direction. If the question does not state it, the runs must show it: the slope of the
// event over the index on the axis, summed over the rows, differs from 0 by Student's t at 5 %, with the less
// favourable assignment of unknown outcomes. Rows that share random numbers count as if they were one. Fixed
// cells show a slope without a test. Without a direction there is no limit; `place` then says that all or
// none of the runs of the row had the event, or else that there is no direction. A row that clearly changes
// the other way has no limit, and neither has one that rises and falls (estimated_limit()); `place` says so.
// Values without a finished run are left out.
EventLimits event_limits(const SweepResult& result, const LimitQuestion& question,
                         const CellStreams& streams);

// The counts of each cell, for a sweep that does not keep its runs.
struct CellCounts {
  std::function<EventCounts(std::size_t cell)> events;       // counts the finished runs
  std::function<std::int64_t(std::size_t cell)> noted = {};  // finished runs with a note; empty: not known
  // The number of clusters of some cells; empty: the most runs of any of the cells that share random numbers.
  std::function<std::int64_t(const std::vector<std::size_t>& cells)> clusters = {};
};
EventLimits event_limits(const SweepGrid& grid, const CellCounts& cells, const LimitQuestion& question,
                         const CellStreams& streams);

// Returns the differences, or ratios, of the limits at each value of the axis `between` from that at its
// first value, for each combination of the axes other than it and the axis of the question: the values, and
// the columns of add_estimates(), with p for differences. See estimated_limit_comparison(). Without a
// direction, and in a refined sweep, the rows have no interval. pre: `between` is not the axis of the
// question; the direction is that of event_limits().
Table limit_comparisons(const SweepResult& result, const LimitQuestion& question, std::size_t between,
                        const CellStreams& streams, LimitComparison comparison);

// Adaptive refinement of a sweep: more runs where the probability of an event is uncertain.

struct RefinementRule {
  std::string measure = "popped_through";
  double threshold = 0.5;            // the event happens when the measure is above this
  std::uint64_t budget = 0;          // total number of runs, including the first round
  int first_replicates = 1;          // replicates of a newly sampled cell; also the number that a round adds
  std::vector<std::size_t> strides;  // strides of the first round's cells along each axis, powers of two
};

// Returns the runs that the next round adds. They depend on the finished runs alone, so every continuation
// adds the same ones. A cell is uncertain while a score test does not tell its probability from 0.5, with the
// less favourable assignment of unknown outcomes: |events - n / 2| < 1.96 sqrt(n) / 2 (Wilson's interval). An
// uncertain cell is given more replicates, up to the maximum. If one of two neighbouring cells is uncertain,
// or if they lie on different sides of 0.5, the cell half way between them is sampled. Cells with the fewest
// runs come first. Empty if no cell is uncertain, or if the budget is spent. Because runs are added depending
// on earlier results, the intervals cover a little less than their nominal level. pre: no run is pending.
std::vector<std::size_t> next_round(const SweepResult& result, const RefinementRule& rule);

}  // namespace remote_touch
