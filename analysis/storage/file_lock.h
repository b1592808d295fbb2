// One process at a time.
#pragma once

#include <filesystem>

namespace remote_touch {

// Held from construction to destruction, for the right to write a file: by a file beside it with the ending
// ".lock", so that the file itself can be replaced and read at any time. A killed process holds no lock,
// however many such files it leaves. Also removes what killed processes left of the file under temporary
// names. Throws InputError naming the target when another process holds it or the folder cannot be written. A
// device needs no lock, and a file system without locks gives none.
class FileLock {
 public:
  explicit FileLock(const std::filesystem::path& target);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  std::filesystem::path lock_;
  int descriptor_ = -1;
};

}  // namespace remote_touch
