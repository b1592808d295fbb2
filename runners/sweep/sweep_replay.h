// A run of a stored sweep again, as a full trace.
#pragma once

#include <filesystem>
#include <string>

#include "analysis/sweeps/sweep_file.h"
#include "analysis/trace/trace.h"
#include "runners/simulation/simulation.h"
#include "runners/sweep/sweep.h"

namespace remote_touch {

struct Replay {
  Experiment experiment;
  Trace trace;
  std::string digest;
};

// Runs it and writes the trace, with the points of its frames in frame_hash. pre: sweep is the one that the
// file stored has the configuration of. Throws InputError when a file cannot be read or written.
Replay replay_run(const StoredSweep& stored, const Sweep& sweep, std::size_t run, SimulationOptions options,
                  const std::filesystem::path& output);

// "3,4": the place of a cell on each axis.
std::string cell_text(const SweepResult& result, std::size_t cell);

}  // namespace remote_touch
