// Does the runs of a sweep, and repeats one of them.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "analysis/sweeps/sweep_file.h"
#include "analysis/sweeps/sweep_result.h"
#include "analysis/trace/trace.h"
#include "core/kernels/kernels.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/sweep/sweep.h"
#include "runners/sweep/work_pool.h"

namespace remote_touch {

struct SweepRunOptions {
  const Kernels* kernels = nullptr;         // null: the machine's best
  const std::atomic<bool>* stop = nullptr;  // when set, the sweep ends with Interrupted
  // Called with the place of each finished run, one call at a time; what it throws ends the sweep.
  std::function<void(std::size_t place)> finished = {};
  SideBySide runs = side_by_side;  // distributes the runs over threads
};

// The results of one run.
struct RunOutcome {
  RunState state = RunState::pending;
  std::vector<double> values = {};  // one for each measure; empty if the run failed
  std::uint64_t notes = 0;          // bits as in SweepResult::notes
  std::string error = {};
};
// Does one run. Throws std::bad_alloc, because lack of memory is not a result of the run, and Interrupted.
RunOutcome do_run(const Sweep& sweep, const SweepRunOptions& options, std::size_t cell, int replicate);

// Does every pending run, in parallel. The bits and the notes of a run do not depend on threads or order. A
// run that fails is marked and its error is stored; the other runs continue. Throws Interrupted, or the
// exception of `finished`, after the runs in progress have ended. Returns the number of runs for which there
// was no memory; they are still pending.
std::size_t do_pending_runs(const Sweep& sweep, SweepResult& result, const SweepRunOptions& options);

// Adds the next round of refinement: its runs become pending. Returns false if there is none, see
// next_round(). pre: the result is whole.
bool add_round(const Sweep& sweep, SweepResult& result);

// Does all rounds in memory. Failed runs are in the result, with their errors. Throws std::bad_alloc.
SweepResult run_sweep(const Sweep& sweep, const SweepRunOptions& options);

// Repeats one run of a stored sweep, as a full trace.

struct Replay {
  Experiment experiment;
  Trace trace;
  TextAttributes attributes;  // its provenance
  std::string digest;
  RunReport report;
};

enum class Strict { no, yes };  // yes: a note on the run is an error

// Runs the run again and writes its trace, with frame_hash computed. If output is empty, the trace is not
// written. attributes: of the stored sweep. pre: `sweep` was read from their configuration. Throws InputError
// if a file cannot be read or written. With Strict::yes it also throws InputError if there is a note on the
// run; then nothing is written.
Replay replay_run(const TextAttributes& attributes, const Sweep& sweep, std::size_t run,
                  SimulationOptions options, const std::filesystem::path& output, Strict strict = Strict::no);

}  // namespace remote_touch
