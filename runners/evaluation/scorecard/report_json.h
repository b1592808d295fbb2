// scorecard.json: the data from which scripts/plot makes the page of a scorecard. It contains all decisions
// (which method is marked, which words a verdict has); a page only formats them.
#pragma once

#include <string>

#include "runners/evaluation/scorecard/evaluation.h"

namespace remote_touch {

inline constexpr const char* kScorecardSchema = "remote-touch-scorecard/5";

// SI units, null for a number that is missing. The lists "methods" and "laws" have the same order everywhere.
std::string to_json(const ScorecardReport& report);

}  // namespace remote_touch
