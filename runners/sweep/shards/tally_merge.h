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
// Writes the merged tally, as merge_shards() does. Throws InputError also for a shard some of whose runs are
// known to be wrong, see require_trusted(). An output that exists is replaced if its runs are all in the
// shards. The memory holds the whole tally and one shard.
MergedTally merge_tallies(const MergeRequest& request);

}  // namespace remote_touch
