// An answer about a sweep as text.
#pragma once

#include <string>

#include "analysis/figures/figure.h"

namespace remote_touch {

// Returns the caption and each table with names, units and at most 60 rows; "-" stands for a value that is
// not known. Tables of single curves, which repeat rows, are left out. A note states how many of the `asked`
// runs are not finished.
std::string answer_text(const Figure& answer, std::size_t done, std::size_t asked);

}  // namespace remote_touch
