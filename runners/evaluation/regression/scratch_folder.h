// A place for runs whose results are read and thrown away.
#pragma once

#include <filesystem>
#include <string>

namespace remote_touch {

// A new folder in TMPDIR, which is gone with all files in it (it may hold no folders) when this ends. A
// program that is killed, or finds no memory inside a library, leaves its folder; the next one removes that.
// Whose folder is still in use is told by a lock, which a process loses when it ends. Throws InputError where
// no folder can be made.
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
