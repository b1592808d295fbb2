// Files that appear complete or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/parameters/parameter.h"

namespace remote_touch {

// Files that appear while a command computes are not overwritten.

// The refusal to replace a file that holds what nothing else holds. No option overrides it: code that lets
// --force through a refusal passes this one on.
class KeptFile : public InputError {
 public:
  using InputError::InputError;
};

// Decides which existing files an output may replace. A file without content may always be replaced, an
// unfinished recording never.
struct ReplacementRule {
  // Returns true for a file of this program and of the kind that is written. Not called for an empty file.
  std::function<bool(const std::filesystem::path& file)> is_ours;
  std::string kind = "a result";  // the name of such a file in messages
  bool force = false;             // any other file may be replaced too
  std::string force_option = "--force";

  bool allows(const std::filesystem::path& file) const;
};

// Sets the rule for a target for the rest of the process, or until the next call. A target without a rule is
// always replaced.
void set_replacement_rule(const std::filesystem::path& target, ReplacementRule rule);

// Throws InputError unless the rule allows the output and its folder is writable; KeptFile for an unfinished
// recording. Sets the rule, because the file may be written by others while the result is computed.
void require_output(const std::filesystem::path& output, const ReplacementRule& rule);

// Renames the temporary file to the target, or to what the target links to. Returns 0, or the errno of the
// call that failed: EEXIST if the rule keeps the existing file. If another process replaces an existing file
// between the check of the rule and the rename, its file is lost. A file that appears where there was none is
// never lost, if the file system supports RENAME_NOREPLACE.
int rename_by_rule(const std::filesystem::path& temporary, const std::filesystem::path& target);

// Does the same for a finished result. If the rule keeps the existing file, it throws InputError, which names
// the target, and leaves the result beside it as TARGET.kept-PID.
int rename_or_keep(const std::filesystem::path& temporary, const std::filesystem::path& target);

// Writes to a temporary name in the same folder, flushes to the disk and renames over the target, or over
// what it links to. On failure (missing folder, no permission, full disk, a pipe, a socket or a device)
// throws InputError naming the target, and leaves neither a partial nor a temporary file. The new file has
// the permissions of the file that it replaces. The only device that can be written is /dev/null. A file that
// appeared at the target meanwhile is kept if a ReplacementRule requires it.
void write_file_atomically(const std::filesystem::path& target, const void* data, std::size_t size);
inline void write_file_atomically(const std::filesystem::path& target, const std::string& text) {
  write_file_atomically(target, text.data(), text.size());
}

// Throws the InputError of write_file_atomically() if the folder is missing or not writable, or if the target
// is not a file, before any work is done for the file. Never blocks.
void require_writable(const std::filesystem::path& target);

// Makes the folder and those above it. Throws InputError.
void make_folder(const std::filesystem::path& folder);

// Throws the InputError of a target that cannot be written. error: the errno of the call that failed.
[[noreturn]] void refuse_writing(const std::filesystem::path& target, int error, const std::string& expected);

// Throws InputError if the target is a device: a file that is renamed to it would replace it.
void require_no_device(const std::filesystem::path& target);

// Throws InputError, which names the target, if the target and the input are the same file.
void require_different_file(const std::filesystem::path& target, const std::filesystem::path& input);

// Returns the temporary name, in the target's folder, under which this process writes the target.
std::filesystem::path temporary_of(const std::filesystem::path& target);
// Flushes the temporary file to the disk and renames it over the target. Fails like write_file_atomically(),
// also if a file appeared meanwhile.
void move_into_place(const std::filesystem::path& temporary, const std::filesystem::path& target);

// Writes bytes to an open file. Returns 0, or the errno of the call that failed; `done` is the number of
// bytes that were written.
int write_all(int descriptor, const void* data, std::size_t size, std::size_t& done);

// Writes an open file to the disk, if it and its file system support that. Returns 0, or the errno.
int flush(int descriptor);

// True if that is the name of the open file.
bool is_name_of(const std::filesystem::path& name, int descriptor);

// Gives an open file the permissions of the file at the place, if there is one; its owner can always read and
// write it.
void keep_permissions(int descriptor, const std::filesystem::path& place);

// Flushes the folder of the target, so that the names of its files outlast a power cut, if the file system
// supports that.
void flush_folder(const std::filesystem::path& target);

// Returns the file to which a symbolic link leads, whether it exists or not, or any other name unchanged.
// Throws InputError for a ring of links.
std::filesystem::path resolved(const std::filesystem::path& target);

// Removes temporary files of the target that killed programs left. pre: no other process writes it now.
void remove_leftovers(const std::filesystem::path& target);

// Files that belong together and may be larger than memory: all of them appear, or none.

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
