// Repeats one run of a stored sweep, as a full trace.
#pragma once

#include <filesystem>
#include <string>

#include "analysis/sweeps/sweep_file.h"
#include "analysis/trace/trace.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/sweep/sweep.h"

namespace remote_touch {

struct Replay {
  Experiment experiment;
  Trace trace;
  TextAttributes attributes;  // its provenance
  std::string digest;
  RunReport report;
};

enum class Strict { no, yes };  // yes: a note on the run is an error

// Runs the run again and writes its trace, with frame_hash computed. If output is empty, the trace is not
// written. pre: `sweep` was read from the configuration of `stored`. Throws InputError if a file cannot be
// read or written. With Strict::yes it also throws InputError if there is a note on the run; then nothing is
// written.
Replay replay_run(const StoredSweep& stored, const Sweep& sweep, std::size_t run, SimulationOptions options,
                  const std::filesystem::path& output, Strict strict = Strict::no);

}  // namespace remote_touch
