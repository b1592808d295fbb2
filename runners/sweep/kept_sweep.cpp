#include "runners/sweep/kept_sweep.h"

#include <algorithm>

#include "analysis/sweeps/tally_file.h"
#include "runners/sweep/stored_sweep.h"

namespace remote_touch {

KeptSweep read_kept_sweep(const std::filesystem::path& file, Extent extent) {
  if (const Hdf5Reader reader(file); is_tally(reader)) {
    StoredTally stored = read_tally(reader);
    const std::string warning = distrust_of(stored.attributes);
    return {std::move(stored.tally), std::move(stored.attributes), warning};
  }
  StoredSweep stored = extent == Extent::whole ? read_stored_sweep(file) : read_sweep(file);
  const std::string warning = damage_text(stored);
  return {std::move(stored.result), std::move(stored.attributes), warning};
}

std::size_t count_of(const SweepResult& result, RunState state) {
  return static_cast<std::size_t>(std::count(result.state.begin(), result.state.end(), state));
}

std::size_t count_of(const SweepTally& tally, RunState state) {
  std::int64_t runs = 0;
  for (const CellTally& cell : tally.tallies)
    runs += state == RunState::done ? cell.done : state == RunState::failed ? cell.failed : 0;
  return static_cast<std::size_t>(runs);
}

}  // namespace remote_touch
