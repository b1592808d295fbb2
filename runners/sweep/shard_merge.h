// Merges the shards of a sweep into one file: those with runs and those with tallies.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "analysis/sweeps/sweep_result.h"
#include "analysis/sweeps/sweep_tally.h"
#include "analysis/trace/trace.h"
#include "core/parameters/parameter.h"

namespace remote_touch {

// Merges the shards of a sweep into one file, block by block: their runs may be more than the memory holds.

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

// Calls write(), which writes the merged file, and returns its result. If write() throws InputError, throws
// InputError with the same text and "; nothing was changed". A merge that fails changes no file.
template <class Write>
std::string or_unchanged(const Write& write) {
  try {
    return write();
  } catch (const InputError& error) {
    throw InputError(error.what() + std::string("; nothing was changed"));
  }
}

// Throws KeptFile, with --force too, if the output is a sweep or a tally with runs that the shards do not
// hold, because it was refined or continued. Throws InputError, unless --force is given, for an output
// that cannot be read. merged: returns the runs that the shards hold; only called if the output has runs.
void require_nothing_more(const MergeRequest& request, const std::function<RunRanges()>& merged);

// Called before the file is written, at least once, with the runs in increasing order; each block is a part
// of the result.
using EachBlock = std::function<void(const SweepResult& block)>;

// Writes the merged file and returns its digest. A whole sweep has the bytes that one process would have
// written. pre: the caller holds the lock of the output. Throws InputError, which names the file, for a shard
// that is missing, given twice, damaged, unfinished or of another sweep, build or recording, and for an
// output that holds runs that the shards do not.
std::string merge_shards(const MergeRequest& request, const EachBlock& each_block);

// Merges the shards of a sweep that keeps tallies.

// Writes and returns the merged tally, as merge_shards() does. Throws InputError also for a shard some of
// whose runs are known to be wrong, see require_trusted(). An output that exists is replaced if its runs are
// all in the shards. The memory holds the whole tally and one shard.
SweepTally merge_tallies(const MergeRequest& request);

}  // namespace remote_touch
