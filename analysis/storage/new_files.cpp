#include "analysis/storage/new_files.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/replacement_rule.h"
#include "core/parameters/input_error.h"

namespace remote_touch {

NewFiles::~NewFiles() {
  if (descriptor_ >= 0) ::close(descriptor_);
  put_back();
}

void NewFiles::refuse(const File& file, int error, const std::string& remark) const {
  refuse_writing(file.target, error, "a writable folder with free space for " + contents_ + remark);
}

void NewFiles::begin(const std::filesystem::path& target) {
  close();
  require_writable(target);
  remove_leftovers(target);
  File& file = files_.emplace_back(File{target, resolved(target), temporary_of(target)});
  std::error_code absent;
  const auto there = std::filesystem::status(file.place, absent);
  if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there)) refuse(file, EINVAL);
  descriptor_ = ::open(file.temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) refuse(file, errno);
  keep_permissions(descriptor_, file.place);
}

void NewFiles::append(const std::string& bytes) {
  std::size_t done = 0;
  if (const int error = write_all(descriptor_, bytes.data(), bytes.size(), done); error != 0)
    refuse(files_.back(), error);
  size_ += bytes.size();
}

void NewFiles::close() {
  if (descriptor_ < 0) return;
  int error = flush(descriptor_);
  if (::close(descriptor_) != 0 && error == 0) error = errno;
  descriptor_ = -1;
  if (error != 0) refuse(files_.back(), error);
}

// Gives the file that is replaced a second name, so that the target is the old or the new file at every
// moment.
void NewFiles::keep_old(File& file) {
  std::error_code absent, failure;
  if (!std::filesystem::exists(file.place, absent)) return;
  const std::filesystem::path old = file.temporary.string() + "-old";
  if (::link(file.place.c_str(), old.c_str()) != 0 &&
      !std::filesystem::copy_file(file.place, old, failure)) {  // a file system without links
    ::unlink(old.c_str());
    refuse(file, failure.value());
  }
  file.old = old;
}

void NewFiles::finish() {
  close();
  if (files_.size() > 1)
    for (File& file : files_) keep_old(file);
  for (File& file : files_) {
    if (const int error = rename_by_rule(file.temporary, file.target); error == EEXIST)
      throw InputError(file.target.string(),
                       "was written by another program meanwhile, and is unchanged: expected "
                       "another file, or --force" +
                           put_back());
    else if (error != 0)
      refuse(file, error, put_back());
    file.is_new = true;
  }
  const std::vector<File> done = std::move(files_);  // they now stay, whatever happens
  files_.clear();
  for (const File& file : done)
    if (!file.old.empty()) ::unlink(file.old.c_str());
  for (const File& file : done) flush_folder(file.place);
}

std::string NewFiles::put_back() {
  std::string remark;
  for (File& file : files_) {
    if (!file.is_new) {
      ::unlink(file.temporary.c_str());
      if (!file.old.empty()) ::unlink(file.old.c_str());
    } else if (file.old.empty()) {
      ::unlink(file.place.c_str());
    } else if (::rename(file.old.c_str(), file.place.c_str()) != 0) {
      // The next writer of the file would remove it under its present name.
      const std::string kept = file.place.string() + ".old-" + std::to_string(::getpid());
      const bool is_moved = ::rename(file.old.c_str(), kept.c_str()) == 0;
      remark += "; the old " + file.place.string() + " is now " + (is_moved ? kept : file.old.string());
    }
    file.is_new = false, file.old.clear();
  }
  return remark;
}

}  // namespace remote_touch
