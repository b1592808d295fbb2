#include "runners/sweep/shards/shard_merge.h"

#include <cstdio>
#include <optional>

#include "analysis/storage/other_processes.h"
#include "analysis/tally/tally_file.h"
#include "core/parameters/input_error.h"
#include "runners/interfaces/cli/commands.h"
#include "runners/interfaces/cli/outputs.h"
#include "runners/interfaces/cli/sweep_summary.h"
#include "runners/sweep/shards/tally_merge.h"

namespace remote_touch {

int command_merge(const CommandLine& line, const MergeCommand& command) {
  const FileLock lock = lock_output(line, command.output, {});
  std::vector<std::string> notes;
  const MergeRequest request{command.shards, command.output, command.partial ? Partial::yes : Partial::no,
                             line.force, [&](const std::string& note) { notes.push_back(note); }};
  if (is_tally(Hdf5Reader(command.shards.front()))) {
    const MergedTally merged = merge_tallies(request);
    return print_summary(command.output, merged.tally, merged.digest);
  }
  std::optional<SweepSummary> summary;
  const std::string digest = merge_shards(request, [&](const SweepResult& block) {
    if (!summary) summary.emplace(block);
    summary->add(block);
  });
  const int code = summary->print(command.output, digest);
  for (const std::string& note : notes) std::printf("  note: %s\n", printable(note).c_str());
  return code;
}

}  // namespace remote_touch
