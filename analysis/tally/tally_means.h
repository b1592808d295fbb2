// Means of the measures of a tally, and how often its events happened.
#pragma once

#include <string>
#include <vector>

#include "analysis/sweeps/sweep_result.h"
#include "analysis/tally/sweep_tally.h"

namespace remote_touch {

// Returns the count of an event in the finished runs of a cell; a run whose measure is unknown counts as a
// run without the event. pre: the measure of that number is an event (is_event()).
Tally event_count(const SweepTally& tally, std::size_t measure, std::uint64_t cell);

// Returns a table as sweep_means() does. The interval is Wilson's if the measure is an event, else that of
// student_mean() with a group for each cell. outline: of the tally. pre: no axis with common noise is pooled,
// because a tally does not know which of its runs had the same noise.
Table tally_means(const SweepTally& tally, const SweepResult& outline, std::size_t measure,
                  const std::vector<std::size_t>& by);

}  // namespace remote_touch
