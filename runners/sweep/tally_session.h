// Runs a sweep that keeps tallies into its file.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>

#include "analysis/storage/other_processes.h"
#include "analysis/tally/tally_file.h"
#include "core/kernels/kernels.h"
#include "runners/sweep/sweep.h"

namespace remote_touch {

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

  const SweepTally& tally() const { return plan_.tally; }
  const TextAttributes& attributes() const { return plan_.attributes; }  // the file's, without the digest
  std::uint64_t own_runs() const { return plan_.own_runs; }
  const std::string& digest() const { return digest_; }  // digest of the file, after run()

 private:
  std::vector<std::uint64_t> next_runs(std::size_t count);
  void store();

  const Sweep& sweep_;
  const Shard shard_;
  const std::filesystem::path file_;
  const FileLock lock_;
  TallyPlan plan_;
  std::size_t next_cell_ = 0;  // index, within the shard, of the first cell that may lack runs
  std::string digest_;
};

}  // namespace remote_touch
