// A sweep as its file keeps it: with its runs, or with a tally of each cell. Commands read either as one.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <variant>

#include "analysis/storage/hdf5_file.h"
#include "analysis/sweeps/sweep_result.h"
#include "analysis/sweeps/sweep_tally.h"

namespace remote_touch {

struct KeptSweep {
  std::variant<SweepResult, SweepTally> kept;
  TextAttributes attributes;
  std::string warning = {};  // one line if some runs are known to be wrong or are left out

  const SweepGrid& grid() const {
    return std::visit([](const SweepGrid& grid) -> const SweepGrid& { return grid; }, kept);
  }
};

// whole: runs of other shards are `elsewhere`; as_stored: a part stays a part.
enum class Extent { whole, as_stored };
// Throws InputError for a file that is not a sweep or a tally.
KeptSweep read_kept_sweep(const std::filesystem::path& file, Extent extent);

// Returns the number of runs in a state. A tally knows those that are done or failed.
std::size_t count_of(const SweepResult& result, RunState state);
std::size_t count_of(const SweepTally& tally, RunState state);

}  // namespace remote_touch
