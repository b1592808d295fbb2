// A sweep in HDF5: group /sweep with the axes as dimension scales, one array for each measure, and arrays for
// state, notes and error. The arrays of a part have one dimension, whose scale is the array `run` of its
// runs. Beside it, the runs of several parts while these are merged.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
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

// The runs of several parts of a sweep, in the order of their numbers; together they may be larger than the
// memory. add() copies each part to a temporary file on the disk, which has no name and so vanishes with the
// program. After complete(), values() returns blocks over all runs. The memory grows with the number of parts
// and of failed runs, and without `is_whole` with that of all runs.
class RunSpool {
 public:
  // Blocks of this many places, from multiples of it on, are read fastest.
  static constexpr std::size_t kWindow = 1 << 17;
  // Returns the values at `count` places from `first` on of an array of a part: a measure, state, notes,
  // error or run.
  using PartValues = std::function<Values(const std::string& array, std::size_t first, std::size_t count)>;

  // outline: the sweep, with measures but without values. is_refined: runs that no part holds are not
  // sampled. beside: a file in whose folder the temporary file lies. Throws InputError, which names `beside`,
  // if it cannot be written.
  RunSpool(const SweepResult& outline, bool is_refined, const std::filesystem::path& beside);
  ~RunSpool();
  RunSpool(const RunSpool&) = delete;
  RunSpool& operator=(const RunSpool&) = delete;

  // name: of the part, for errors. Throws InputError if its runs are not increasing numbers of the sweep's
  // runs.
  void add(const std::string& name, std::size_t held, const PartValues& values);
  // Call once, after the last part. is_whole: the places are the runs of the whole sweep, else the runs of
  // the parts. Throws InputError if two parts hold the same run, and, for a whole sweep without refinement,
  // if a run is missing.
  void complete(bool is_whole);

  // The sweep without values, after complete() with the runs that the places have.
  const SweepResult& outline() const { return outline_; }
  bool is_refined() const { return is_refined_; }
  std::size_t longest_error() const;  // bytes, at least 1
  // The values of an array at places that complete() defined. With refinement there is also the array round.
  Values values(const std::string& array, std::size_t first, std::size_t count);

 private:
  struct Part {
    std::string name;
    std::size_t held;
    std::uint64_t offset;  // bytes before its arrays in the temporary file; one array follows the other
  };
  using Words = std::vector<std::uint64_t>;  // the bits of values of any type
  std::size_t array_number(const std::string& array) const;
  std::size_t place_of(std::uint64_t run) const;
  void put(const Words& words);
  Words get(const Part& part, std::size_t array, std::size_t first, std::size_t count) const;
  void copy_errors(const Part& part, const PartValues& values);
  void find_held();
  void find_starts(std::size_t part);
  void load(std::size_t array, std::size_t window);
  void scatter(std::size_t array, std::size_t part);
  void require_each_run_once(std::size_t window);
  std::vector<std::string> errors(std::size_t first, std::size_t count) const;
  std::uint64_t word(std::size_t array, std::size_t place);

  SweepResult outline_;
  const bool is_refined_;
  const std::filesystem::path beside_;
  std::vector<std::string> arrays_;  // the names of those in the temporary file; the first is run
  int file_ = -1;
  std::uint64_t size_ = 0;
  std::vector<Part> parts_;
  std::map<std::uint64_t, std::string> errors_;  // errors of the failed runs
  std::vector<Words> starts_;  // each part has the first of its places in each window, and their number
  std::size_t loaded_array_ = 0, loaded_window_ = 0;
  bool is_loaded_ = false;
  Words loaded_;
};

}  // namespace remote_touch
