// A sweep in HDF5: group /sweep with the axes as dimension scales, one array for each measure, and arrays for
// state, notes and error. The arrays of a part have one dimension, whose scale is the array `run` of its
// runs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_reader.h"
#include "analysis/sweeps/sweep_result.h"

namespace remote_touch {

// The arrays of a sweep in its file, beside the measures.

Column state_column(const SweepResult& result);

// Digest of axes, the runs of a part, measures, states, errors and, with refinement, rounds. Notes are not
// part of it, because they do not change the numbers.
std::string digest(const SweepResult& result);

// Writes the finished file and returns its digest. Equal results are equal bytes. attributes: configuration,
// provenance and shard; schema and digest are added. Throws InputError if the file cannot be written.
std::string write_sweep(const std::filesystem::path& file, const SweepResult& result,
                        const TextAttributes& attributes);

// A sweep whose arrays are larger than the memory.
struct SweepInBlocks {
  const SweepResult& outline;  // has no values in measures, state, round, error and notes
  bool is_refined = false;
  std::size_t longest_error = 1;  // bytes, at least 1
  // Returns the values at `count` places from `first` on of an array, which is named as in the file: a
  // measure, state, notes, error or round. They may be asked for several times.
  std::function<Values(const std::string& array, std::size_t first, std::size_t count)> values;
};
// Writes the finished file as above, with the same bytes, and returns its digest.
std::string write_sweep(const std::filesystem::path& file, const SweepInBlocks& sweep,
                        const TextAttributes& attributes);

// The content of a file, finished or in progress. Runs that were written only in part are pending.
// read_sweep() throws InputError for a file that is not a sweep, or was changed since it was written.
struct StoredSweep {
  SweepResult result;
  TextAttributes attributes;  // all but schema, digest, and the names of axes, measures and note kinds
  bool in_progress = false;
  std::size_t damaged_runs = 0;  // number of runs of a file in progress with a wrong checksum; not done
};
StoredSweep read_sweep(const Hdf5Reader& file);
// Reads all but the values of the runs: axes, number of replicates, measures, kinds of notes and attributes.
StoredSweep read_sweep_outline(const Hdf5Reader& file);
// Reads the file again if a running sweep has replaced it.
StoredSweep read_sweep(const std::filesystem::path& file, const RunInChild& run = in_own_child);

// Writes the file as it is while the sweep runs. The arrays that runs change are not compressed, so that runs
// can be written in place. A checksum of every run replaces the error texts. A run whose checksum is wrong
// was written only in part.
void write_sweep_in_progress(const std::filesystem::path& file, const SweepResult& result,
                             const TextAttributes& attributes);
std::int32_t checksum(const SweepResult& result, std::size_t place);
// Digest of what does not change while the sweep runs: axes, rounds, kinds of notes and attributes.
std::string plan_digest(const SweepResult& result, TextAttributes attributes);
// Size of that file, bytes. The finished one is usually smaller.
std::size_t size_in_progress(const SweepResult& result, const TextAttributes& attributes);

// The result file of a sweep while it runs.

// The file is written whole at the start, with space for every run, so a full disk is noticed before any work
// is done, and the file can be read at any time. Every finished run is then written in place at once: a
// killed program loses no finished run. pre: the caller holds the file's lock (other_processes.h).
class SweepInProgress {
 public:
  // already_there: the file exists, is in progress and holds this result. If false, the file is written.
  // Throws InputError if it cannot be written.
  SweepInProgress(const std::filesystem::path& file, const SweepResult& result,
                  const TextAttributes& attributes, bool already_there);
  ~SweepInProgress();
  SweepInProgress(const SweepInProgress&) = delete;
  SweepInProgress& operator=(const SweepInProgress&) = delete;

  // Stores the values, the state and the notes of the run at a place. One call at a time. Throws InputError
  // if the file cannot be written.
  void record(const SweepResult& result, std::size_t at);
  // Makes everything recorded survive a power cut. Throws InputError if that fails, and also if the file was
  // replaced or removed.
  void flush();

 private:
  void put(std::int64_t offset, const void* value, std::size_t size);

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::vector<std::int64_t> measure_offsets_;
  std::int64_t state_offset_ = 0, checksum_offset_ = 0, notes_offset_ = 0;
};

}  // namespace remote_touch
