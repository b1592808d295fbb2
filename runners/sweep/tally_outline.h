// A tally as the outline of a sweep, for what needs axes, cells and the names of measures only.
#pragma once

#include "analysis/sweeps/sweep_result.h"
#include "analysis/tally/sweep_tally.h"

namespace remote_touch {

// Returns a part without runs.
inline SweepResult outline_of(const SweepTally& tally) {
  SweepResult outline;
  outline.axes = tally.axes, outline.replicates = tally.replicates;
  outline.measures = tally.measures, outline.note_kinds = tally.note_kinds;
  outline.part.emplace();
  outline.start(false);
  return outline;
}

}  // namespace remote_touch
