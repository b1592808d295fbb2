// The measures of two traces that differ: which of them got better or worse.
#pragma once

#include <optional>
#include <vector>

#include "analysis/comparison/column_source.h"
#include "analysis/comparison/judgement.h"

namespace remote_touch {

// Those of the catalog in use that both traces have, in its order; a stored trace has none of settled
// contact, which need more than its columns. None at all where one of the two lacks a column, or they differ
// in length. Where the outcomes of the runs differ, see is_outcome(), other measures have only changed. Holds
// one trace at a time.
std::optional<std::vector<ValueComparison>> compare_measures(const ColumnSource& baseline,
                                                             const ColumnSource& candidate,
                                                             const Tolerances& tolerances);

}  // namespace remote_touch
