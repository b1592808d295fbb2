#include "analysis/sweeps/sweep_in_progress.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "analysis/storage/hdf5_reader.h"
#include "core/parameters/input_error.h"

namespace remote_touch {

namespace {
[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& problem) {
  throw InputError(file.string(), problem);
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
  if (descriptor_ < 0)
    refuse(file_, std::string("cannot be written (") + std::strerror(errno) + "): expected a writable file");
}

SweepInProgress::~SweepInProgress() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void SweepInProgress::record(const SweepResult& result, std::size_t run) {
  const auto place = static_cast<std::int64_t>(run);
  for (std::size_t i = 0; i < measure_offsets_.size(); ++i) {
    const double value = std::get<std::vector<double>>(result.measures[i].values)[run];
    put(measure_offsets_[i] + 8 * place, &value, sizeof value);
  }
  const auto state = static_cast<std::int32_t>(result.state[run]);
  const std::int32_t sum = checksum(result, run);
  put(state_offset_ + 4 * place, &state, sizeof state);
  if (!result.notes.empty()) put(notes_offset_ + 4 * place, &result.notes[run], sizeof result.notes[run]);
  put(checksum_offset_ + 4 * place, &sum, sizeof sum);
}

void SweepInProgress::put(std::int64_t offset, const void* value, std::size_t size) {
  ssize_t written;
  do {
    written = ::pwrite(descriptor_, value, size, offset);
  } while (written < 0 && errno == EINTR);
  if (written == static_cast<ssize_t>(size)) return;
  refuse(file_, std::string("cannot be written (") + std::strerror(written < 0 ? errno : ENOSPC) +
                    "); finished runs are kept in the file; free some space and repeat the command");
}

void SweepInProgress::flush() {
  if (::fdatasync(descriptor_) != 0 && errno != EINVAL && errno != EROFS)
    refuse(file_, std::string("cannot be written (") + std::strerror(errno) +
                      "); finished runs are kept in the file; free some space and repeat the command");
  struct stat ours = {}, there = {};
  if (::fstat(descriptor_, &ours) != 0 || ::stat(file_.c_str(), &there) != 0 || ours.st_ino != there.st_ino ||
      ours.st_dev != there.st_dev)
    refuse(file_,
           "was replaced or removed by another program during the sweep: expected only one that writes it");
}

}  // namespace remote_touch
