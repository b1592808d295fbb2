// Sweeps that are written to a file, with their runs or with tallies, and continue where an earlier call
// stopped.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "analysis/storage/other_processes.h"
#include "analysis/sweeps/sweep_file.h"
#include "analysis/sweeps/tally_file.h"
#include "core/kernels/kernels.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep.h"
#include "runners/sweep/sweep_parts.h"
#include "runners/sweep/sweep_run.h"

namespace remote_touch {

// Checks whether files belong to one sweep, made by one build.

// Returns the attributes of the build that made a result. Runs of different builds are not put into one file.
TextAttributes build_of(const TextAttributes& attributes);

// Checks a file that a command continues. Throws InputError, which names the file, if it is of another sweep,
// shard or build, so that it is not overwritten.
void require_same_sweep(const std::filesystem::path& file, const TextAttributes& theirs,
                        const TextAttributes& ours);

// Checks files that are merged, without their attributes `shard`. Throws InputError, which names both files,
// unless they are of one sweep, one build and the same recordings.
struct MergedFile {
  std::string file;
  const TextAttributes& attributes;
};
void require_same_origin(const MergedFile& part, const MergedFile& first);

// A sweep that is written to a file, and continues where an earlier call stopped.

// The work of a sweep that is left after the results in its file, if that exists.
struct SweepPlan {
  SweepResult result;         // failed runs are pending again
  TextAttributes attributes;  // the existing file's, else as given; `input_digests` always as given
  bool in_progress = false;   // the file exists, can be written in place, and holds this result
  bool is_there = false;
  bool is_finished = false;  // the file exists and equals what a finished sweep with this result would write
};
// Throws InputError for a file that is not a sweep (also for a pipe or a device), or
// that belongs to another configuration, shard or build. Throws InputError also if a recording that a
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
  std::size_t done() const { return count_of(plan_.result, RunState::done); }
  KeptSweep kept() const { return {plan_.result, plan_.attributes}; }

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

// Runs a sweep that keeps tallies into its file.

// The runs of a sweep or a shard that a file holds, and the number that it should hold.
struct TallyPlan {
  SweepTally tally;
  TextAttributes attributes;   // attributes of the file; the given ones if it does not exist
  std::uint64_t own_runs = 0;  // number of runs of the shard
};
// Reads the file, if it exists. attributes: configuration, provenance and shard of this call. Throws
// InputError if the file belongs to another sweep, shard or build, or to other recordings, if some of its
// runs are known to be wrong (require_trusted()), and if the shard has no cells or more than 1e6.
TallyPlan tally_plan_in_file(const Sweep& sweep, const Shard& shard, const TextAttributes& attributes,
                             const std::filesystem::path& file);

// Adds the runs of the batch that were made.
void add_runs(const SweepResult& batch, SweepTally& tally);

// The file is a tally of the runs that are done. It is written again every ten seconds, or less often if that
// takes longer than a twentieth of the time: a killed program loses the runs since then. The same command
// makes the missing runs. A failed run is counted; it is not made again. The finished tally has the same
// bytes however often it was interrupted, and with any number of threads.
class TallySession {
 public:
  // Locks the file and reads it with tally_plan_in_file(). Throws InputError also if another process writes
  // the file.
  TallySession(const Sweep& sweep, const Shard& shard, const TextAttributes& attributes,
               const std::filesystem::path& file);

  // See SweepSession::run(). Returns false if no run was left. Throws Interrupted, after the finished runs
  // have been stored; InputError if the file cannot be written or a recording has changed; std::bad_alloc.
  using Progress = std::function<void(std::size_t done, std::size_t total, std::size_t earlier)>;
  bool run(const Kernels& kernels, const std::atomic<bool>* stop, const Progress& progress);

  // The same with runs that are done elsewhere, in consecutive batches of about batch_s seconds. do_batch:
  // puts the outcomes of the pending runs into the batch. If it throws, the runs that are pending are not
  // added.
  using DoBatch = std::function<void(SweepResult& batch)>;
  bool run(const DoBatch& do_batch, double batch_s, const Progress& progress);

  // States in the file that some of its runs are wrong. They cannot be taken out of the sums, so no session
  // continues such a file. why: one line. do_batch may call it, and must then throw.
  void distrust(const std::string& why);

  const SweepTally& result() const { return plan_.tally; }
  std::size_t done() const { return plan_.tally.held.count(); }  // with the failed runs
  KeptSweep kept() const { return {plan_.tally, plan_.attributes, distrust_of(plan_.attributes)}; }
  std::uint64_t own_runs() const { return plan_.own_runs; }

 private:
  std::vector<std::uint64_t> next_runs(std::size_t count);
  void store();

  const Sweep& sweep_;
  const Shard shard_;
  const std::filesystem::path file_;
  const FileLock lock_;
  TallyPlan plan_;
  std::size_t next_cell_ = 0;  // index, within the shard, of the first cell that may lack runs
};

}  // namespace remote_touch
