// Sweeps that are written to a file, with their runs or with tallies, and continue where an earlier call
// stopped; and their shards: merged into one file, and checked.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "analysis/storage/other_processes.h"
#include "analysis/sweeps/sweep_file.h"
#include "analysis/sweeps/sweep_result.h"
#include "analysis/sweeps/sweep_tally.h"
#include "core/kernels/kernels.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep.h"
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

// A sweep that is written to a file, and continues where an earlier call stopped.
//
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

// Merges the shards of a sweep into one file, with its runs or with a tally.

// yes: shards may be missing or unfinished. The merged file then is a part of the sweep: it states its
// shards, and can be merged with others unless some of its runs are pending.
enum class Partial { no, yes };

struct MergeRequest {
  std::vector<std::string> shards;  // files of shards, or of parts that were merged from some
  std::string output;
  Partial partial = Partial::no;
  bool force = false;  // an output that is no sweep may be replaced
  // Called with a line about each shard that has runs with a wrong checksum, see damage_text(). May be empty.
  std::function<void(const std::string& line)> note = {};
};

// Called before the file is written, at least once, with the runs in increasing order; each block is a part
// of the result, whose runs may be more than the memory holds.
using EachBlock = std::function<void(const SweepResult& block)>;

// Writes the merged file and returns its digest. A whole sweep has the bytes that one process would have
// written. A merge that fails changes no file. pre: the caller holds the lock of the output. Throws
// InputError, which names the file, for a shard that is missing, given twice, damaged, unfinished or of
// another sweep, build or recording, and, unless forced, for an output that cannot be read. Throws KeptFile,
// also if forced, for an output that holds runs that the shards do not, because it was refined or continued.
std::string merge_shards(const MergeRequest& request, const EachBlock& each_block);
// The same for a sweep that keeps a tally, which is returned. Throws InputError also for a shard some of
// whose runs are known to be wrong, see require_trusted(). The memory holds the whole tally and one shard.
SweepTally merge_tallies(const MergeRequest& request);

// The progress of the shards in a folder.

// running: a process of this machine writes the file, or it was written in the last minute. stopped: neither,
// so its process was ended or lost; the same sweep command continues it. absent: there is no file.
enum class ShardState { finished, running, stopped, absent };

struct ShardProgress {
  ShardSet shards;
  std::string file;  // name in the folder; empty if absent
  ShardState state = ShardState::absent;
  std::size_t runs = 0, done = 0, failed = 0;  // runs that the file holds
  double written_s_ago = 0;                    // time since the file was written last
  double runs_per_s = 0;                       // mean since the file was made; 0 if it is not known
  std::string distrust = {};                   // see distrust_of()
};

// The shards of one sweep, sorted by their lowest index. Each is in one file.
struct SweepProgress {
  std::string title;
  int shard_count = 1;
  std::size_t runs = 0;  // number of runs of the whole sweep
  std::vector<ShardProgress> files;
  std::vector<std::string> unread;  // one line for each file that could not be read, with the reason

  std::size_t count(ShardState state) const;  // number of shards in that state
  std::size_t done() const;
  std::size_t failed() const;
  // Time until all runs are done if the shards that run now do the rest at their speed, seconds; none if no
  // speed is known.
  std::optional<double> left_s() const;
};

// Reads the files *.h5 of the folder. Files without an attribute `shard` are left out. Throws InputError if
// there is no shard, or if there are shards of several sweeps.
SweepProgress progress_of_shards(const std::filesystem::path& folder);

// Makes some runs of a stored sweep again: a machine that computes wrongly is found by another one.

// True for one number in each thousand; its place differs from one thousand to the next.
constexpr bool is_rechecked(std::uint64_t number) {
  return number % 1000 == (99 + 7 * (number / 1000)) % 1000;
}

struct RecheckOptions {
  const Kernels* kernels = nullptr;         // null: the machine's best
  const std::atomic<bool>* stop = nullptr;  // when set, the check ends with Interrupted
  std::function<void(std::size_t done, std::size_t total)> progress = {};
  bool all = false;  // every run, instead of those with is_rechecked()
  // Called with each run that was made again, of a tally with each cell, in their order. difference: empty if
  // it is as stored.
  std::function<void(std::uint64_t number, const std::string& difference)> each = {};
};
struct Recheck {
  std::size_t made = 0;                 // number of runs that were made again
  std::size_t cells = 0, cells_in = 0;  // number of cells of a tally that were made again; of all its cells
  // A text for each run that differs, with the first difference, such as "run 99: max_force = 1.5, now 1.25".
  // A tally has a text for each cell that differs, such as "cell 3: mean of max_force = 1.5, now 1.25".
  std::vector<std::string> different = {};
};

// Makes the finished and failed runs with is_rechecked() again, or the first run if there is no such run.
// Makes all of them with options.all. Compares state, values and notes, bit for bit. part: a shard or a
// whole sweep. sweep: read from the configuration of the file. Throws Interrupted, and std::bad_alloc.
Recheck recheck(const SweepResult& part, const Sweep& sweep, const RecheckOptions& options);

// The same for a tally, which does not keep single runs. Makes all runs of the cells with is_rechecked()
// again, or of the cell in the middle if there is no such cell, and compares the tally of each cell.
Recheck recheck(const SweepTally& tally, const Sweep& sweep, const RecheckOptions& options);

}  // namespace remote_touch
