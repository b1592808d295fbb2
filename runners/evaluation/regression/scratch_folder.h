// A temporary folder for runs whose results are read and then deleted.
#pragma once

#include <filesystem>
#include <string>

namespace remote_touch {

// A new folder in TMPDIR. The destructor removes it with all its files; it must not contain folders. A
// program that is killed, or runs out of memory inside a library, leaves its folder; the next program removes
// it. A lock marks the folders that are in use, and a process loses its lock when it ends. Throws InputError
// if no folder can be made.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  std::filesystem::path path() const { return path_; }

 private:
  std::string path_;
  int descriptor_ = -1;
};

}  // namespace remote_touch
