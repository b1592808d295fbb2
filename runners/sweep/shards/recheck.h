// Makes some runs of a stored sweep again: a machine that computes wrongly is found by another one.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "analysis/sweeps/sweep_file.h"
#include "analysis/tally/tally_file.h"
#include "core/kernels/kernels.h"
#include "runners/sweep/sweep.h"

namespace remote_touch {

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
