// Merges the shards of a sweep that keeps tallies.
#pragma once

#include <string>

#include "analysis/tally/sweep_tally.h"
#include "runners/sweep/shards/shard_merge.h"

namespace remote_touch {

struct MergedTally {
  SweepTally tally;
  std::string digest;
};
// Writes the merged tally, as merge_shards() does. Refuses a shard with wrong runs, see require_trusted().
// The memory is that of the whole tally and of one shard. An output that is there already is replaced if its
// runs are all in the shards.
MergedTally merge_tallies(const MergeRequest& request);

}  // namespace remote_touch
