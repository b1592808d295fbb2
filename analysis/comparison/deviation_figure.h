// Figure of the deviation between two traces over time.
#pragma once

#include "analysis/comparison/column_source.h"
#include "analysis/comparison/trace_comparison.h"
#include "analysis/figures/figure.h"

namespace remote_touch {

// One panel for each column that differs, at most 8, in the trace's order. A panel has the decimal logarithm
// of the largest deviation in each of up to 2000 intervals of time (NaN if nothing differs), and a dot at the
// first row outside the tolerance. The caption has the first divergent tick.
Figure deviation_figure(const ColumnSource& baseline, const ColumnSource& candidate,
                        const TraceComparison& comparison);

}  // namespace remote_touch
