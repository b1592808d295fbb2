// Checks of shards: their progress in a folder, and some runs of a sweep made again.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/sweeps/sweep_file.h"
#include "analysis/sweeps/sweep_tally.h"
#include "core/kernels/kernels.h"
#include "runners/sweep/sweep.h"
#include "runners/sweep/sweep_parts.h"

namespace remote_touch {

// The progress of the shards in a folder.

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

// Makes some runs of a stored sweep again: a machine that computes wrongly is found by another one.

// True for one number in each thousand; its place differs from one thousand to the next.
constexpr bool is_rechecked(std::uint64_t number) {
  return number % 1000 == (99 + 7 * (number / 1000)) % 1000;
}

struct RecheckOptions {
  const Kernels* kernels = nullptr;         // null: the machine's best
  const std::atomic<bool>* stop = nullptr;  // when set, the check ends with Interrupted
  std::function<void(std::size_t done, std::size_t total)> progress = {};
};
struct Recheck {
  std::size_t made = 0;                 // number of runs that were made again
  std::size_t cells = 0, cells_in = 0;  // number of cells of a tally that were made again; of all its cells
  // A text for each run that differs, with the first difference, such as "run 99: max_force = 1.5, now 1.25".
  // For a tally a text for each cell that differs, such as "cell 3: mean of max_force = 1.5, now 1.25".
  std::vector<std::string> different = {};
};

// Makes the finished and failed runs with is_rechecked() again, or the first run if there is no such run.
// Compares state, values and notes, bit for bit. part: a shard or a whole sweep. sweep: read from the
// configuration of the file. Throws Interrupted, and std::bad_alloc.
Recheck recheck(const SweepResult& part, const Sweep& sweep, const RecheckOptions& options);

// The same for a tally, which does not keep single runs. Makes all runs of the cells with is_rechecked()
// again, or of the cell in the middle if there is no such cell, and compares the tally of each cell.
Recheck recheck(const SweepTally& tally, const Sweep& sweep, const RecheckOptions& options);

}  // namespace remote_touch
