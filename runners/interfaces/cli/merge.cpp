#include "runners/sweep/shards/shard_merge.h"

#include <optional>

#include "analysis/storage/file_lock.h"
#include "analysis/tally/tally_file.h"
#include "runners/interfaces/cli/commands.h"
#include "runners/interfaces/cli/outputs.h"
#include "runners/interfaces/cli/sweep_summary.h"
#include "runners/sweep/shards/tally_merge.h"

namespace remote_touch {

int command_merge(const CommandLine& line, const MergeCommand& command) {
  const FileLock lock = lock_output(line, command.output, {});
  const MergeRequest request{command.shards, command.output, command.partial ? Partial::yes : Partial::no,
                             line.force};
  if (is_tally(Hdf5Reader(command.shards.front()))) {
    const MergedTally merged = merge_tallies(request);
    return print_summary(command.output, merged.tally, merged.digest);
  }
  std::optional<SweepSummary> summary;
  const std::string digest = merge_shards(request, [&](const SweepResult& block) {
    if (!summary) summary.emplace(block);
    summary->add(block);
  });
  return summary->print(command.output, digest);
}

}  // namespace remote_touch
