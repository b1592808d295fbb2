#include "runners/evaluation/regression/scratch_folder.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>

#include "analysis/storage/other_processes.h"
#include "core/parameters/input_error.h"

namespace remote_touch {

namespace {

constexpr const char* kScratchName = "remote-touch-bless-XXXXXX";  // each X is replaced
constexpr std::string_view kScratchStem = "remote-touch-bless-";

std::filesystem::path place_of_scratch() {
  std::error_code failure;
  std::filesystem::path place = std::filesystem::temp_directory_path(failure);
  if (failure) throw InputError("TMPDIR", failure.message() + ": expected a writable folder");
  return place;
}

// Calls use(name) for each name in an open folder. Allocates no memory, unlike readdir() and
// std::filesystem::directory_iterator.
template <class Use>
void for_each_name(int folder, const Use& use) {
  const int list = ::openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (list < 0) return;
  alignas(dirent64) char names[4096];
  for (ssize_t size; (size = ::getdents64(list, names, sizeof names)) > 0;)
    for (ssize_t at = 0; at < size;) {
      const auto* const entry = reinterpret_cast<const dirent64*>(names + at);
      use(entry->d_name);
      at += entry->d_reclen;
    }
  ::close(list);
}

void remove_with_files(int parent, const char* name, int folder) {
  for_each_name(folder, [&](const char* file) { ::unlinkat(folder, file, 0); });
  ::unlinkat(parent, name, AT_REMOVEDIR);
}

int open_folder(int parent, const char* name) {
  return ::openat(parent, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
}

// Removes the folders of programs that could not remove them: folders that no program holds locked.
void remove_abandoned(const std::filesystem::path& place) {
  const int parent = ::open(place.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (parent < 0) return;
  for_each_name(parent, [&](const char* name) {
    if (!std::string_view(name).starts_with(kScratchStem)) return;
    const int folder = open_folder(parent, name);
    if (folder < 0) return;
    if (lock_error(folder, LOCK_EX | LOCK_NB) == 0) remove_with_files(parent, name, folder);
    ::close(folder);
  });
  ::close(parent);
}

[[noreturn]] void refuse_scratch(const std::string& folder, int error) {
  throw InputError(folder,
                   std::string("cannot be made (") + std::strerror(error) + "): expected a writable folder");
}

// Waits for the lock. Returns false if the place has no locks; then no other program can lock the folder
// either, so none removes it.
bool take_lock(const std::string& path, int folder) {
  const int error = lock_error(folder, LOCK_EX);
  if (error == 0 || has_no_locks(error)) return error == 0;
  ::rmdir(path.c_str());
  ::close(folder);
  throw InputError(path, std::string("cannot be locked (") + std::strerror(error) +
                             "): expected a TMPDIR whose locks work, or one without locks");
}

bool has_links(int folder) {
  struct stat about = {};
  return ::fstat(folder, &about) == 0 && about.st_nlink > 0;
}

}  // namespace

ScratchFolder::ScratchFolder() {
  const std::filesystem::path place = place_of_scratch();
  remove_abandoned(place);
  // Another program may classify the folder as abandoned and remove it before it is locked. Then another
  // folder is made.
  do {
    if (descriptor_ >= 0) ::close(descriptor_);
    path_ = place / kScratchName;
    if (!::mkdtemp(path_.data())) refuse_scratch(path_, errno);
    descriptor_ = open_folder(AT_FDCWD, path_.c_str());
    if (descriptor_ < 0) {
      const int error = errno;
      ::rmdir(path_.c_str());
      refuse_scratch(path_, error);
    }
  } while (take_lock(path_, descriptor_) && !has_links(descriptor_));
}

ScratchFolder::~ScratchFolder() {
  remove_with_files(AT_FDCWD, path_.c_str(), descriptor_);
  ::close(descriptor_);
}

}  // namespace remote_touch
