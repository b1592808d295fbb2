// The tables of the scorecard's page.
#pragma once

#include <string>

#include "runners/scorecard/page.h"

namespace remote_touch {

// Successes of all scenes together, and how often each method is significantly best or worst.
std::string overview_table(const ScorecardPage& page);
// Successes at each noise level, and the measures over all of them.
std::string success_table(const ScorecardPage& page, std::size_t scene);
std::string measure_table(const ScorecardPage& page, std::size_t scene);
// The measures at each noise level, collapsed.
std::string level_tables(const ScorecardPage& page, std::size_t scene);
// Costs of ticks and frames relative to the chapter 4 proxy's, or to the first method's.
std::string cost_table(const ScorecardPage& page);
std::string audit_table(const Scorecard& audit);
// A sentence: which methods are best and worst by successes, or that no difference is significant.
std::string verdict(const Scorecard& card, const SceneScore& scene);

}  // namespace remote_touch
