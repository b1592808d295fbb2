// scorecard.json: what scripts/plot needs for the page of a scorecard. All decisions are in it (who is
// marked, which words a verdict has); a page only gives them a form.
#pragma once

#include <string>

#include "runners/evaluation/scorecard/report.h"

namespace remote_touch {

inline constexpr const char* kScorecardSchema = "remote-touch-scorecard/3";

// SI units, null for a number that is not there. Lists "methods" and "laws" have their order everywhere.
std::string to_json(const ScorecardReport& report);

}  // namespace remote_touch
