#include "analysis/storage/atomic_file.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string_view>

#include "analysis/storage/block_journal.h"

namespace remote_touch {
namespace {

// A live session also writes its report from another thread.
std::mutex mutex_of_rules;

std::map<std::filesystem::path, ReplacementRule>& rules() {
  static std::map<std::filesystem::path, ReplacementRule> all;
  return all;
}

std::filesystem::path key_of(const std::filesystem::path& target) {
  std::error_code no_folder;
  return std::filesystem::absolute(target, no_folder).lexically_normal();
}

std::optional<ReplacementRule> rule_of(const std::filesystem::path& target) {
  const std::lock_guard lock(mutex_of_rules);
  const auto found = rules().find(key_of(target));
  return found == rules().end() ? std::nullopt : std::optional(found->second);
}

// A device holds no data that could be lost.
bool holds_something(const std::filesystem::path& file) {
  std::error_code absent;
  return std::filesystem::is_regular_file(file, absent) && std::filesystem::file_size(file, absent) > 0;
}

}  // namespace

bool ReplacementRule::allows(const std::filesystem::path& file) const {
  if (is_journal(file)) return false;
  return force || !holds_something(file) || is_ours(file);
}

void set_replacement_rule(const std::filesystem::path& target, ReplacementRule rule) {
  const std::lock_guard lock(mutex_of_rules);
  rules()[key_of(target)] = std::move(rule);
}

void require_output(const std::filesystem::path& output, const ReplacementRule& rule) {
  if (is_journal(output))
    throw KeptFile(output.string(),
                   "is an unfinished recording and is never overwritten: expected another file");
  if (!rule.allows(output))
    throw InputError(output.string(), "exists already and is not " + rule.kind +
                                          " of this program: expected another file, or " + rule.force_option);
  require_writable(output);
  set_replacement_rule(output, rule);
}

// If the first call fails, for example on a file system without RENAME_NOREPLACE, the rule and the second
// call decide.
int rename_by_rule(const std::filesystem::path& temporary, const std::filesystem::path& target) {
  const std::filesystem::path place = resolved(target);
  if (const auto rule = rule_of(target)) {
    if (::renameat2(AT_FDCWD, temporary.c_str(), AT_FDCWD, place.c_str(), RENAME_NOREPLACE) == 0) return 0;
    std::error_code unreachable;
    if (std::filesystem::exists(std::filesystem::symlink_status(place, unreachable)) && !rule->allows(place))
      return EEXIST;
  }
  return ::rename(temporary.c_str(), place.c_str()) == 0 ? 0 : errno;
}

int rename_or_keep(const std::filesystem::path& temporary, const std::filesystem::path& target) {
  const int error = rename_by_rule(temporary, target);
  if (error != EEXIST) return error;
  // The result gets another name, because the next command with this output would remove the temporary file.
  const std::string kept = resolved(target).string() + ".kept-" + std::to_string(::getpid());
  if (::rename(temporary.c_str(), kept.c_str()) != 0) return errno;
  flush_folder(kept);
  const auto rule = rule_of(target);
  throw InputError(target.string(),
                   "was written by another program while this one computed, and is unchanged: "
                   "the result is in " +
                       kept + ", expected another file, or " + rule.value().force_option);
}

namespace {

constexpr const char* kTemporary = ".partial-";

// True for /dev/null and /dev/full, which accept or refuse all data at once. Any other device may block for
// ever.
bool is_sink(const struct stat& there) {
  return S_ISCHR(there.st_mode) && (there.st_rdev == ::makedev(1, 3) || there.st_rdev == ::makedev(1, 7));
}

// Returns 0, or the errno of the call that failed.
int write_and_flush(int file, const void* data, std::size_t size) {
  std::size_t done = 0;
  const int error = write_all(file, data, size, done);
  return error == 0 ? flush(file) : error;
}

std::filesystem::path folder_of(const std::filesystem::path& target) {
  return target.has_parent_path() ? target.parent_path() : ".";
}

[[noreturn]] void refuse_size(const std::filesystem::path& target, int error, std::size_t size) {
  refuse_writing(target, error, "a writable folder with free space for " + std::to_string(size) + " bytes");
}

bool is_folder(const std::filesystem::path& target) {
  std::error_code unreachable;
  return std::filesystem::is_directory(target, unreachable);
}

// True for a device that is written in place, because a file cannot be renamed over it. A pipe would block.
bool is_written_in_place(const std::filesystem::path& target) {
  struct stat there = {};
  if (::stat(target.c_str(), &there) != 0 || S_ISREG(there.st_mode) || S_ISDIR(there.st_mode)) return false;
  if (!is_sink(there)) throw InputError(target.string(), "is a pipe, a socket or a device: expected a file");
  return true;
}

// Writes the target's temporary file and flushes it to the disk. Returns its name.
std::filesystem::path write_temporary(const std::filesystem::path& target, const void* data,
                                      std::size_t size) {
  std::filesystem::path temporary = temporary_of(target);
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) refuse_size(target, errno, size);
  keep_permissions(file, resolved(target));
  int error = write_and_flush(file, data, size);
  if (::close(file) != 0 && error == 0) error = errno;
  if (error == 0) return temporary;
  ::unlink(temporary.c_str());
  refuse_size(target, error, size);
}

}  // namespace

void refuse_writing(const std::filesystem::path& target, int error, const std::string& expected) {
  throw InputError(target.string(),
                   std::string("cannot be written (") + std::strerror(error) + "): expected " + expected);
}

void require_no_device(const std::filesystem::path& target) {
  std::error_code absent;
  if (std::filesystem::exists(target, absent) && !std::filesystem::is_regular_file(target, absent))
    throw InputError(target.string(), "is a device: expected a file");
}

int write_all(int descriptor, const void* data, std::size_t size, std::size_t& done) {
  for (done = 0; done < size;) {
    const ssize_t written = ::write(descriptor, static_cast<const char*>(data) + done, size - done);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return written < 0 ? errno : ENOSPC;
    done += static_cast<std::size_t>(written);
  }
  return 0;
}

int flush(int descriptor) {
  return ::fsync(descriptor) == 0 || errno == EINVAL || errno == EROFS ? 0 : errno;
}

bool is_name_of(const std::filesystem::path& name, int descriptor) {
  struct stat held = {}, there = {};
  return ::fstat(descriptor, &held) == 0 && ::stat(name.c_str(), &there) == 0 &&
         held.st_ino == there.st_ino && held.st_dev == there.st_dev;
}

void flush_folder(const std::filesystem::path& target) {
  const int folder = ::open(folder_of(target).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  ::fsync(folder);
  ::close(folder);
}

void keep_permissions(int descriptor, const std::filesystem::path& place) {
  struct stat there = {};
  if (::stat(place.c_str(), &there) == 0 && S_ISREG(there.st_mode))
    ::fchmod(descriptor, (there.st_mode & 0777) | S_IRUSR | S_IWUSR);
}

void require_different_file(const std::filesystem::path& target, const std::filesystem::path& input) {
  std::error_code absent;
  if (std::filesystem::equivalent(target, input, absent))
    throw InputError(target.string(), "is the input file: expected another output file");
}

std::filesystem::path resolved(const std::filesystem::path& target) {
  constexpr int kMaxLinks = 40;  // limit of the system
  std::filesystem::path place = target;
  std::error_code unreachable;
  for (int links = 0; std::filesystem::is_symlink(place, unreachable); ++links) {
    if (links == kMaxLinks) refuse_writing(target, ELOOP, "a file");
    const auto next = std::filesystem::read_symlink(place, unreachable);
    if (unreachable) break;
    place = place.parent_path() / next;  // next itself, if it is absolute
  }
  return place;
}

void require_writable(const std::filesystem::path& target) {
  if (is_folder(target)) refuse_writing(target, EISDIR, "a file");
  if (is_written_in_place(target)) return;
  const std::filesystem::path folder = folder_of(resolved(target));
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    refuse_writing(target, errno, "a file in a writable folder");
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure)
    throw InputError(folder.string(),
                     "cannot be made (" + failure.message() + "): expected a writable folder");
}

void write_file_atomically(const std::filesystem::path& target, const void* data, std::size_t size) {
  if (is_folder(target)) refuse_size(target, EISDIR, size);
  if (is_written_in_place(target)) {
    const int file = ::open(target.c_str(), O_WRONLY | O_CLOEXEC);
    if (file < 0) refuse_size(target, errno, size);
    const int error = write_and_flush(file, data, size);
    ::close(file);
    if (error != 0) refuse_size(target, error, size);
    return;
  }
  const std::filesystem::path place = resolved(target), temporary = write_temporary(target, data, size);
  if (const int error = rename_or_keep(temporary, target); error != 0) {
    ::unlink(temporary.c_str());
    refuse_size(target, error, size);
  }
  flush_folder(place);
}

std::filesystem::path temporary_of(const std::filesystem::path& target) {
  return resolved(target).string() + kTemporary + std::to_string(::getpid());
}

void move_into_place(const std::filesystem::path& temporary, const std::filesystem::path& target) {
  const std::filesystem::path place = resolved(target);
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CLOEXEC);
  int error = file < 0 ? errno : 0;
  if (error == 0) error = flush(file);
  if (error == 0) keep_permissions(file, place);
  if (file >= 0) ::close(file);
  if (error == 0) error = rename_or_keep(temporary, target);
  if (error != 0) {
    ::unlink(temporary.c_str());
    refuse_writing(target, error, "a writable folder with free space for the file");
  }
  flush_folder(place);
}

void remove_leftovers(const std::filesystem::path& target) {
  const std::filesystem::path place = resolved(target), folder = folder_of(place);
  const std::string start = place.filename().string() + kTemporary;
  // std::filesystem::directory_iterator is not used: it ends the program if memory runs out.
  const std::unique_ptr<DIR, int (*)(DIR*)> list(::opendir(folder.c_str()), ::closedir);
  while (const dirent* const entry = list ? ::readdir(list.get()) : nullptr)
    if (std::string_view(entry->d_name).starts_with(start)) ::unlink((folder / entry->d_name).c_str());
}

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
