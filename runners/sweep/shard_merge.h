// Merges the shards of a sweep into one file, with its runs or with a tally.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "analysis/sweeps/sweep_result.h"
#include "analysis/sweeps/sweep_tally.h"

namespace remote_touch {

// yes: shards may be missing or unfinished. The merged file then is a part of the sweep: it states its
// shards, and can be merged with others unless some of its runs are pending.
enum class Partial { no, yes };

struct MergeRequest {
  std::vector<std::string> shards;  // files of shards, or of parts that were merged from some
  std::string output;
  Partial partial = Partial::no;
  bool force = false;  // an output that is no sweep may be replaced
  // Called with a line about each shard that has runs with a wrong checksum, see damage_text(). May be empty.
  std::function<void(const std::string& line)> note = {};
};

// Called before the file is written, at least once, with the runs in increasing order; each block is a part
// of the result, whose runs may be more than the memory holds.
using EachBlock = std::function<void(const SweepResult& block)>;

// Writes the merged file and returns its digest. A whole sweep has the bytes that one process would have
// written. A merge that fails changes no file. pre: the caller holds the lock of the output. Throws
// InputError, which names the file, for a shard that is missing, given twice, damaged, unfinished or of
// another sweep, build or recording, and, unless forced, for an output that cannot be read. Throws KeptFile,
// also if forced, for an output that holds runs that the shards do not, because it was refined or continued.
std::string merge_shards(const MergeRequest& request, const EachBlock& each_block);
// The same for a sweep that keeps a tally, which is returned. Throws InputError also for a shard some of
// whose runs are known to be wrong, see require_trusted(). The memory holds the whole tally and one shard.
SweepTally merge_tallies(const MergeRequest& request);

}  // namespace remote_touch
