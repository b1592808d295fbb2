#include "analysis/sweeps/sweep_in_progress.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/hdf5_reader.h"
#include "core/parameters/input_error.h"

namespace remote_touch {

namespace {
[[noreturn]] void refuse_record(const std::filesystem::path& file, int error) {
  throw InputError(file.string(),
                   std::string("cannot be written (") + std::strerror(error) +
                       "); finished runs are kept in the file; free some space and repeat the command");
}
}  // namespace

SweepInProgress::SweepInProgress(const std::filesystem::path& file, const SweepResult& result,
                                 const TextAttributes& attributes, bool already_there)
    : file_(file) {
  if (!already_there) write_sweep_in_progress(file, result, attributes);
  const Hdf5Reader there(file);
  for (const Column& measure : result.measures)
    measure_offsets_.push_back(there.offset("/sweep/" + measure.name));
  state_offset_ = there.offset("/sweep/state");
  checksum_offset_ = there.offset("/sweep/checksum");
  if (!result.notes.empty()) notes_offset_ = there.offset("/sweep/notes");
  descriptor_ = ::open(file_.c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor_ < 0) refuse_writing(file_, errno, "a writable file");
}

SweepInProgress::~SweepInProgress() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void SweepInProgress::record(const SweepResult& result, std::size_t at) {
  const auto place = static_cast<std::int64_t>(at);
  for (std::size_t i = 0; i < measure_offsets_.size(); ++i) {
    const double value = std::get<std::vector<double>>(result.measures[i].values)[at];
    put(measure_offsets_[i] + 8 * place, &value, sizeof value);
  }
  const auto state = static_cast<std::int32_t>(result.state[at]);
  const std::int32_t sum = checksum(result, at);
  put(state_offset_ + 4 * place, &state, sizeof state);
  if (!result.notes.empty()) put(notes_offset_ + 8 * place, &result.notes[at], sizeof result.notes[at]);
  put(checksum_offset_ + 4 * place, &sum, sizeof sum);
}

void SweepInProgress::put(std::int64_t offset, const void* value, std::size_t size) {
  ssize_t written;
  do {
    written = ::pwrite(descriptor_, value, size, offset);
  } while (written < 0 && errno == EINTR);
  if (written == static_cast<ssize_t>(size)) return;
  refuse_record(file_, written < 0 ? errno : ENOSPC);
}

void SweepInProgress::flush() {
  if (::fdatasync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) refuse_record(file_, errno);
  if (!is_name_of(file_, descriptor_))
    throw InputError(
        file_.string(),
        "was replaced or removed by another program during the sweep: expected only one that writes it");
}

}  // namespace remote_touch
