// A sweep that is written to a file, and continues where an earlier call stopped.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "analysis/storage/other_processes.h"
#include "analysis/sweeps/sweep_file.h"
#include "runners/sweep/shard.h"
#include "runners/sweep/sweep.h"
#include "runners/sweep/sweep_run.h"

namespace remote_touch {

// The work of a sweep that is left after the results in its file, if that exists.
struct SweepPlan {
  SweepResult result;         // failed runs are pending again
  TextAttributes attributes;  // the existing file's, else as given; `input_digests` always as given
  bool in_progress = false;   // the file exists, can be written in place, and holds this result
  bool is_there = false;
  bool is_finished = false;  // the file exists and equals what a finished sweep with this result would write
};
// Throws InputError for a file that is not a sweep (also for a pipe or a device), that has an earlier schema,
// or that belongs to another configuration, shard or build. Throws InputError also if a recording that a
// finished run has read was changed. A recording that only failed runs have read may be repaired.
SweepPlan plan_in_file(const Sweep& sweep, const Shard& shard, const TextAttributes& attributes,
                       const std::filesystem::path& file);

// Holds the file's lock from before it reads the file until it has written it for the last time.
class SweepSession {
 public:
  SweepSession(const Sweep& sweep, const Shard& shard, const TextAttributes& attributes,
               const std::filesystem::path& file);

  // Does everything that is left, round by round, and writes the finished file. progress: runs done, all runs
  // so far, and how many of them were done before. Returns false if nothing was left. Throws Interrupted, or
  // InputError when the file cannot be written or runs found no memory; finished runs are then in the file.
  // Throws InputError when a recording changed meanwhile; no run of this call is then in the file.
  using Progress = std::function<void(std::size_t done, std::size_t total, std::size_t earlier)>;
  bool run(const Kernels& kernels, const std::atomic<bool>* stop, const Progress& progress);

  // The same with runs that are done elsewhere. do_runs: puts the outcomes of the pending runs into the
  // result, calls stored(place) after each, and returns the number of runs for which there was no memory.
  using DoRuns =
      std::function<std::size_t(SweepResult& result, const std::function<void(std::size_t)>& stored)>;
  bool run(const DoRuns& do_runs, const Progress& progress);

  // Makes these runs pending again, also in the file: their outcomes were wrong. The runs of later rounds of
  // refinement depend on them, and are not sampled any more. do_runs may call it, and must then throw.
  void forget(const std::vector<std::size_t>& places);

  const SweepResult& result() const { return plan_.result; }

 private:
  bool add_round_if_whole();
  void require_unchanged_inputs(const SweepResult& before);
  void do_round(const DoRuns& do_runs, const Progress& progress);

  const Sweep& sweep_;
  const Shard shard_;
  const std::filesystem::path file_;
  FileLock lock_;
  SweepPlan plan_;
};

}  // namespace remote_touch
