// The measures of two traces that differ: which of them got better or worse.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/comparison/column_source.h"
#include "analysis/comparison/judgement.h"
#include "analysis/storage/hdf5_file.h"

namespace remote_touch {

// Compares the measures of the catalog in use that both traces have, in its order. A stored trace has no
// measures of settled contact, which need more than its columns. Returns none if one of the traces lacks a
// column, or if they differ in length. If the outcomes of the runs differ, see is_outcome(), other measures
// are only judged as changed. The attributes of each trace hold its configuration, which determines how far
// its proxy may lie behind the surface. If this program cannot read it, the measures that depend on this are
// NaN. Holds one trace at a time.
std::optional<std::vector<ValueComparison>> compare_measures(const ColumnSource& baseline,
                                                             const TextAttributes& baseline_attributes,
                                                             const ColumnSource& candidate,
                                                             const TextAttributes& candidate_attributes,
                                                             const Tolerances& tolerances);

// "the baseline has a tick every 1 ms, the candidate every 2 ms": runs of as many ticks, but of another
// duration, whose measures say nothing about each other. Empty if the ticks are equally far apart, if the
// runs have other numbers of ticks, or if one does not state its times.
std::string tick_difference(const ColumnSource& baseline, const ColumnSource& candidate);

// "one run popped through: the other measures are not judged". Empty if the runs have the same outcome, see
// is_outcome(). measures: the result of compare_measures().
std::string outcome_difference(const std::vector<ValueComparison>& measures);

}  // namespace remote_touch
