// Files that belong together and may be larger than memory: all of them appear, or none.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace remote_touch {

// The files are written one after the other under temporary names beside their targets, and renamed at the
// end. Every member throws InputError, which names the target, if it cannot be written. After that, or
// without finish(), the destructor removes the new files and restores the old ones. If finish() cannot put
// an old file back, it keeps it beside its target, and the message names it. Only a program that is killed
// between two renames leaves some new and some old.
class NewFiles {
 public:
  // contents: what needs the space, for errors.
  explicit NewFiles(std::string contents = "the exported files") : contents_(std::move(contents)) {}
  ~NewFiles();
  NewFiles(const NewFiles&) = delete;
  NewFiles& operator=(const NewFiles&) = delete;

  // Begins a file. target: a regular file, or absent. pre: no other process writes it now.
  void begin(const std::filesystem::path& target);
  void append(const std::string& bytes);  // appends to the file that was begun last
  void finish();

  std::size_t count() const { return files_.size(); }
  unsigned long long size() const { return size_; }  // total size in bytes

 private:
  struct File {
    std::filesystem::path target, place, temporary, old = {};
    bool is_new = false;  // true after its rename
  };
  void close();
  void keep_old(File& file);
  std::string put_back();  // returns where the old files are that could not be put back
  [[noreturn]] void refuse(const File& file, int error, const std::string& remark = "") const;
  const std::string contents_;
  std::vector<File> files_;
  int descriptor_ = -1;
  unsigned long long size_ = 0;
};

}  // namespace remote_touch
