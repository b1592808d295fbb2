// Means of the measures of a sweep and differences between the values of one of its axes, with 95 %
// intervals: the rows of tables of estimates.
#pragma once

#include <string>
#include <vector>

#include "analysis/sweeps/sweep_result.h"
#include "analysis/sweeps/sweep_tally.h"
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

}  // namespace remote_touch
