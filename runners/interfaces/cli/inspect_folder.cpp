// `inspect` of a folder with the shards of a sweep.
#include <cstdio>

#include "core/parameters/input_error.h"
#include "runners/interfaces/cli/commands.h"
#include "runners/sweep/shards/shard_folder.h"

namespace remote_touch {

namespace {

// "40 s", "12 min", "3.5 h"
std::string duration_text(double seconds) {
  char text[32];
  if (seconds < 90)
    std::snprintf(text, sizeof text, "%.0f s", seconds);
  else if (seconds < 5400)
    std::snprintf(text, sizeof text, "%.0f min", seconds / 60);
  else
    std::snprintf(text, sizeof text, "%.1f h", seconds / 3600);
  return text;
}

}  // namespace

int inspect_folder(const std::string& folder) {
  const SweepProgress all = progress_of_shards(folder);
  std::printf("%s: %s\n", printable(folder).c_str(), printable(all.title).c_str());
  std::printf("  %d shards: %zu finished, %zu running, %zu stopped, %zu not begun\n", all.shard_count,
              all.count(ShardState::finished), all.count(ShardState::running), all.count(ShardState::stopped),
              all.count(ShardState::absent));
  std::printf("  %zu of %zu runs done, %zu failed", all.done(), all.runs, all.failed());
  if (const auto left = all.left_s())
    std::printf(", about %s left at the present speed", duration_text(*left).c_str());
  std::puts("");
  for (const ShardProgress& shard : all.files)
    if (shard.state == ShardState::running || shard.state == ShardState::stopped)
      std::printf("  %s: shard %s, %s: %zu of %zu runs, written %s ago\n",
                  shard.state == ShardState::running ? "running" : "stopped", shard.shards.text().c_str(),
                  printable(shard.file).c_str(), shard.done + shard.failed, shard.runs,
                  duration_text(shard.written_s_ago).c_str());
  for (const ShardProgress& shard : all.files)
    if (!shard.distrust.empty())
      std::printf("  %s: %s\n", printable(shard.file).c_str(), printable(shard.distrust).c_str());
  for (const std::string& line : all.unread) std::printf("  not read: %s\n", printable(line).c_str());
  return all.unread.empty() ? kDone : kCheckFailed;
}

}  // namespace remote_touch
