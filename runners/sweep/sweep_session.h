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
#include "analysis/sweeps/sweep_tally.h"
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
  // The results; failed runs of a sweep that keeps its runs are pending again. The attributes are those of
  // the file, else as given; `input_digests` always as given.
  KeptSweep made;
  bool in_progress = false;  // the file exists, can be written in place, and holds this result
  bool is_finished = false;  // the file exists and equals what a finished sweep with this result would write

  // The numbers of the runs that are done, and of all that the file should have now. A tally counts failed
  // runs as done, because they are not made again.
  std::size_t done() const;
  std::size_t total(const Shard& shard) const;
};
// attributes: configuration, provenance and shard of this call. Throws InputError for a file that is not such
// a sweep (also for a pipe or a device), or that belongs to another configuration, shard or build. Throws
// InputError also if a recording that a finished run has read was changed; one that only failed runs have
// read may be repaired, unless the sweep keeps a tally. A tally is refused if some of its runs are known to
// be wrong (require_trusted()), and if the shard has no cells or more than 1e6.
SweepPlan plan_in_file(const Sweep& sweep, const Shard& shard, const TextAttributes& attributes,
                       const std::filesystem::path& file);

// Adds the runs of the batch that were made.
void add_runs(const SweepResult& batch, SweepTally& tally);

// Holds the file's lock from before it reads the file until it has written it for the last time.
//
// A sweep that keeps its runs stores each of them at once, and does failed runs again. A tally is written
// again every ten seconds, or less often if that takes longer than a twentieth of the time: a killed program
// loses the runs since then. The finished file has the same bytes however often it was interrupted, and with
// any number of threads.
class SweepSession {
 public:
  SweepSession(const Sweep& sweep, const Shard& shard, const TextAttributes& attributes,
               const std::filesystem::path& file);

  // Does everything that is left and writes the finished file. progress: runs done, all runs so far, and how
  // many of them were done before. Returns false if nothing was left. Throws Interrupted, InputError when the
  // file cannot be written, and InputError, or std::bad_alloc for a tally, when runs found no memory;
  // finished runs are then in the file. Throws InputError when a recording changed meanwhile; no run that may
  // have read it is then in the file.
  using Progress = std::function<void(std::size_t done, std::size_t total, std::size_t earlier)>;
  bool run(const Kernels& kernels, const std::atomic<bool>* stop, const Progress& progress);

  // The same with runs that are done elsewhere. do_runs: puts the outcomes of the pending runs into `runs`,
  // calls stored(place) after each, and returns the number of runs for which there was no memory. `runs` is
  // the whole sweep or shard, or for a tally the next batch of about batch_s seconds. If do_runs throws, the
  // runs that are not pending are kept.
  using DoRuns =
      std::function<std::size_t(SweepResult& runs, const std::function<void(std::size_t)>& stored)>;
  bool run(const DoRuns& do_runs, double batch_s, const Progress& progress);

  // Makes these runs pending again, also in the file: their outcomes were wrong. The runs of later rounds of
  // refinement depend on them, and are not sampled any more. do_runs may call it, and must then throw. A run
  // that a tally has already cannot be taken out of its sums. why: one line if there is such a run, which the
  // file then states, so that no session continues it; else empty.
  void forget(const std::vector<std::size_t>& runs, const std::string& why);

  const KeptSweep& kept() const { return plan_.made; }
  std::size_t done() const { return plan_.done(); }
  std::size_t total() const { return plan_.total(shard_); }

 private:
  SweepResult& result() { return std::get<SweepResult>(plan_.made.kept); }
  SweepTally& tally() { return std::get<SweepTally>(plan_.made.kept); }
  bool run_rounds(const DoRuns& do_runs, const Progress& progress);
  bool add_round_if_whole();
  void require_unchanged_inputs(const SweepResult& before);
  void do_round(const DoRuns& do_runs, const Progress& progress);
  void forget_stored(const std::vector<std::size_t>& runs);
  bool run_batches(const DoRuns& do_runs, double batch_s, const Progress& progress);
  std::vector<std::uint64_t> next_runs(std::size_t count);
  void store();

  const Sweep& sweep_;
  const Shard shard_;
  const std::filesystem::path file_;
  FileLock lock_;
  SweepPlan plan_;
  SweepResult batch_;          // runs that a tally does not have yet
  std::size_t next_cell_ = 0;  // index, within the shard, of the first cell that may lack runs in the tally
};

}  // namespace remote_touch
