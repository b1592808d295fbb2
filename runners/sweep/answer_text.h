// An answer about a sweep as text.
#pragma once

#include <string>

#include "analysis/figures/figure.h"
#include "analysis/sweeps/sweep_result.h"

namespace remote_touch {

// Returns the caption and each table with names, units and at most 60 rows; "-" stands for a value that is
// not known. Tables of single curves, which repeat rows, are left out. A note states how many runs are not
// finished.
std::string answer_text(const Figure& answer, const SweepResult& sweep);

}  // namespace remote_touch
