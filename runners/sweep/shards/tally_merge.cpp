#include "runners/sweep/shards/tally_merge.h"

#include <filesystem>
#include <optional>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/hdf5_reader.h"
#include "analysis/tally/tally_file.h"
#include "core/parameters/input_error.h"
#include "runners/sweep/shards/seen_shards.h"
#include "runners/sweep/sweep_session.h"

namespace remote_touch {

namespace {

// Throws InputError for a shard some of whose runs are not made.
void require_finished(const std::string& file, const ShardSet& shards, const SweepTally& tally) {
  std::uint64_t cells = 0;
  for (const int index : shards.indices) cells += Shard{index, shards.count}.cells_of(tally.cell_count());
  const std::uint64_t runs = cells * static_cast<std::uint64_t>(tally.replicates);
  if (tally.held.count() < runs)
    throw InputError(
        file, "is not finished (" + std::to_string(runs - tally.held.count()) +
                  " runs are left): expected a finished shard (repeat its sweep command), or --partial");
}

}  // namespace

MergedTally merge_tallies(const MergeRequest& request) {
  require_no_device(request.output);
  std::optional<StoredTally> merged;
  SeenShards seen;
  for (const std::string& file : request.shards) {
    std::error_code absent;
    if (std::filesystem::equivalent(file, request.output, absent))
      throw InputError(request.output, "is one of the shards: expected another file");
    StoredTally part = read_tally(Hdf5Reader(file));
    require_trusted(file, part.attributes);
    const ShardSet shards = take_shards(part.attributes, file);
    if (merged) require_same_origin({file, part.attributes}, {request.shards.front(), merged->attributes});
    seen.add(file, shards);
    if (request.partial == Partial::no) require_finished(file, shards, part.tally);
    if (!merged)
      merged = std::move(part);
    else if (const std::string obstacle = merged->tally.obstacle(part.tally); !obstacle.empty())
      throw InputError(file, "cannot be added (" + obstacle + "): expected shards of one sweep");
    else
      merged->tally.add(std::move(part.tally));
  }
  if (request.partial == Partial::no) seen.require_complete();
  if (!seen.are_complete()) merged->attributes.emplace_back("shard", seen.all().text());
  require_nothing_more(request, [&] { return merged->tally.held; });
  const std::string digest =
      or_unchanged([&] { return write_tally(request.output, merged->tally, merged->attributes); });
  return {std::move(merged->tally), digest};
}

}  // namespace remote_touch
