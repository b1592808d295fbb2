// The result file of a sweep while it runs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "analysis/sweeps/sweep_file.h"

namespace remote_touch {

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
