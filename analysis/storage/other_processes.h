// Other processes: a child that does what may crash, locks that let one process at a time write, and the
// bytes that processes of one machine exchange.
#pragma once

#include <cstddef>
#include <cstring>
#include <filesystem>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace remote_touch {

// Runs work that may hang, crash or take all memory, such as a library that reads a file of unknown origin,
// in a separate process.

struct ChildLimits {
  std::size_t memory_bytes;  // added to the memory that this process has
  unsigned processor_s;
};

// Limits for reading a file: 512 MiB plus memory_for_each_byte for each of its bytes; 1 s plus 1 s for each
// MiB.
ChildLimits limits_to_read(const std::filesystem::path& file, std::size_t memory_for_each_byte);

// Returns the result of `work`. Its changes to memory do not affect this process. Throws std::runtime_error
// with the message of the exception of `work`, or with the reason why the child process ended.
std::string in_child(const ChildLimits& limits, const std::function<std::string()>& work);

// A reader whose only input is a string of bytes, so that a process which was started earlier can run it too.
using ChildReader = std::string (*)(const std::string& question);
// Runs a reader in a child process. Returns and throws like in_child().
using RunInChild =
    std::function<std::string(const ChildLimits&, ChildReader reader, const std::string& question)>;
// Runs the reader in a child that begins for this question and ends with its answer.
std::string in_own_child(const ChildLimits& limits, ChildReader reader, const std::string& question);

// Prepares a child process that has just started. Signals then end it, whatever handlers the program has. The
// end of its parent and exceeding the limits end it too. It holds no lock of its parent.
void become_limited_child(const ChildLimits& limits);

// Locks that let one process at a time write a file, or the files of a folder.

// Calls flock(), again after a signal. Returns 0, or the errno.
int lock_error(int descriptor, int operation);
// True for the errors of flock() on a file system without locks.
bool has_no_locks(int error);

// The right to write a file, held from construction to destruction. The lock is on a file beside it with the
// ending ".lock", so that the file itself can be replaced and read at any time. A killed process holds no
// lock, even if its ".lock" file remains. The constructor also removes temporary files of the target that
// killed processes left. It throws InputError, which names the target, if another process holds the lock, and
// like require_writable(), and if the lock fails for another reason. No lock is taken for /dev/null, or on a
// file system without locks.
class FileLock {
 public:
  explicit FileLock(const std::filesystem::path& target);
  ~FileLock();
  FileLock(FileLock&& other) noexcept;
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  void release();
  std::filesystem::path lock_;
  int descriptor_ = -1;
};

// True if a process of this machine holds the lock of a file. The lock itself is not touched. False where the
// system does not list its locks.
bool is_being_written(const std::filesystem::path& target);

// The right to write files in a folder, held from construction to destruction; it leaves no file, whatever
// ends the process. Throws InputError, which names the folder, if another process holds it, and if the lock
// fails for another reason. No lock is taken if the folder cannot be opened, or on a file system without
// locks.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

// Packs values one after the other, as they are in memory and without names. The bytes are for another
// process of this machine, or for files that never leave it.
class Packer {
 public:
  virtual ~Packer() = default;
  virtual void bytes(const void* data, std::size_t size) = 0;
  template <class Value>
  void value(const Value& v) {
    static_assert(std::is_arithmetic_v<Value> || std::is_enum_v<Value>);
    bytes(&v, sizeof v);
  }
  template <class Value>
  void list(const std::vector<Value>& values) {
    value(values.size());
    bytes(values.data(), values.size() * sizeof(Value));
  }
  void list(const std::vector<std::string>& texts) {
    value(texts.size());
    for (const std::string& t : texts) text(t);
  }
  void text(const std::string& t) {
    value(t.size());
    bytes(t.data(), t.size());
  }
};

class MemoryPacker final : public Packer {
 public:
  void bytes(const void* data, std::size_t size) override {
    packed_.append(static_cast<const char*>(data), size);
  }
  std::string take() { return std::move(packed_); }

 private:
  std::string packed_;
};

// Reads values in the order in which a Packer wrote them. The bytes may be damaged: the first value that is
// missing, and all later ones, are left unchanged.
class Unpacker {
 public:
  Unpacker(const char* begin, const char* end) : at_(begin), end_(end) {}
  explicit Unpacker(const std::string& bytes) : Unpacker(bytes.data(), bytes.data() + bytes.size()) {}
  bool good() const { return good_; }                 // true if nothing was missing
  bool done() const { return good_ && at_ == end_; }  // true if, in addition, nothing is left
  template <class Value>
  void value(Value& v) {
    if (has(1, sizeof v)) std::memcpy(&v, at_, sizeof v), at_ += sizeof v;
  }
  template <class Value>
  void list(std::vector<Value>& values) {
    std::size_t count = 0;
    value(count);
    if (!has(count, sizeof(Value))) return;
    values.resize(count);
    if (count > 0) std::memcpy(static_cast<void*>(values.data()), at_, count * sizeof(Value));
    at_ += count * sizeof(Value);
  }
  void list(std::vector<std::string>& texts) {
    std::size_t count = 0;
    value(count);
    for (std::size_t i = 0; i < count && good_; ++i) text(texts.emplace_back());
  }
  void text(std::string& t) {
    std::size_t count = 0;
    value(count);
    if (has(count, 1)) t.assign(at_, count), at_ += count;
  }

 private:
  bool has(std::size_t count, std::size_t size) {
    good_ = good_ && count <= static_cast<std::size_t>(end_ - at_) / size;
    return good_;
  }
  const char *at_, *end_;
  bool good_ = true;
};

}  // namespace remote_touch
