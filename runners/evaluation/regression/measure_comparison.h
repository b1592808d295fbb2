// The measures of two traces that differ: which of them got better or worse.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/comparison/compared_columns.h"
#include "analysis/comparison/sweep_comparison.h"
#include "analysis/storage/hdf5_file.h"

namespace remote_touch {

struct ComparedMeasures {
  std::vector<ValueComparison> all;
  // Why some or all of them are only judged as changed, such as "one run popped through: the other measures
  // are not judged"; empty if there is no reason.
  std::string not_judged = {};
};

// Compares the measures of the catalog in use that both traces have, in its order. A stored trace has no
// measures of settled contact, which need more than its columns. Returns none if one of the traces lacks a
// column, or if they differ in length. Measures are only judged as changed
// - if the experiments differ and one of the runs drew random numbers: one run of each shows no direction,
// - if the outcomes of the runs differ, see is_outcome(), except the outcomes,
// - if a run has no contact and the measure needs one, see needs_contact().
// configuration: differences between the experiments. The attributes of each trace hold its configuration,
// which determines how far its proxy may lie behind the surface. If this program cannot read it, the measures
// that depend on this are NaN. Holds one trace at a time.
std::optional<ComparedMeasures> compare_measures(const ColumnSource& baseline,
                                                 const TextAttributes& baseline_attributes,
                                                 const ColumnSource& candidate,
                                                 const TextAttributes& candidate_attributes,
                                                 const Tolerances& tolerances,
                                                 const std::vector<std::string>& configuration);

// "the baseline has a tick every 1 ms, the candidate every 2 ms": runs of as many ticks, but of another
// duration, whose measures say nothing about each other. Empty if the ticks are equally far apart, if the
// runs have other numbers of ticks, or if one does not state its times.
std::string tick_difference(const ColumnSource& baseline, const ColumnSource& candidate);

}  // namespace remote_touch
