// The progress of the shards in a folder.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "runners/sweep/sweep_parts.h"

namespace remote_touch {

// running: a process of this machine writes the file, or it was written in the last minute. stopped: neither,
// so its process was ended or lost; the same sweep command continues it. absent: there is no file.
enum class ShardState { finished, running, stopped, absent };

struct ShardProgress {
  ShardSet shards;
  std::string file;  // name in the folder; empty if absent
  ShardState state = ShardState::absent;
  std::size_t runs = 0, done = 0, failed = 0;  // runs that the file holds
  double written_s_ago = 0;                    // time since the file was written last
  double runs_per_s = 0;                       // mean since the file was made; 0 if it is not known
  std::string distrust = {};                   // see distrust_of()
};

// The shards of one sweep, sorted by their lowest index. Each is in one file.
struct SweepProgress {
  std::string title;
  int shard_count = 1;
  std::size_t runs = 0;  // number of runs of the whole sweep
  std::vector<ShardProgress> files;
  std::vector<std::string> unread;  // one line for each file that could not be read, with the reason

  std::size_t count(ShardState state) const;  // number of shards in that state
  std::size_t done() const;
  std::size_t failed() const;
  // Time until all runs are done if the shards that run now do the rest at their speed, seconds; none if no
  // speed is known.
  std::optional<double> left_s() const;
};

// Reads the files *.h5 of the folder. Files without an attribute `shard` are left out. Throws InputError if
// there is no shard, or if there are shards of several sweeps.
SweepProgress progress_of_shards(const std::filesystem::path& folder);

}  // namespace remote_touch
