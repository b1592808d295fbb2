// Means of the measures of a tally, and how often its events happened.
#pragma once

#include <string>
#include <vector>

#include "analysis/sweeps/sweep_result.h"
#include "analysis/tally/sweep_tally.h"

namespace remote_touch {

// Returns the outcomes of an event in the finished runs of a cell. pre: the measure of that number is an
// event (is_event()).
EventCounts event_counts(const SweepTally& tally, std::size_t measure, std::uint64_t cell);

// Returns the number of finished runs of a cell with a note. If there are several kinds of notes, it is that
// of the most frequent kind: a tally does not know how many runs have two kinds.
std::int64_t noted_runs(const SweepTally& tally, std::uint64_t cell);

// Returns a table as sweep_means() does, but without a correction for skewness: a tally has no third moments.
// outline: of the tally. Throws InputError, about the options `by`, if a row would pool cells that share
// random numbers, because a tally does not know which of its runs do.
Table tally_means(const SweepTally& tally, const SweepResult& outline, std::size_t measure,
                  const std::vector<std::size_t>& by, const CellStreams& streams);

}  // namespace remote_touch
