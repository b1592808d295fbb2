// Append-only files of blocks: a recording while it goes on. Whatever ends the program, every block that was
// appended can be read again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace remote_touch {

// A journal begins with this line. Then come its blocks, one after the other, in the byte order of x86-64:
//   char[4] "RTb1", uint32 kind, uint64 number of the block (from 0), uint64 size of its content,
//   uint32 CRC-32 of the content, uint32 CRC-32 of the 28 bytes before; then the content.
inline constexpr std::string_view kJournalOpening = "Remote Touch unfinished recording, format 1\n";

// The journal of a file that is being recorded: FILE.unfinished, beside the file that FILE links to.
std::filesystem::path journal_of(const std::filesystem::path& target);

// True if the file begins as a journal; the rest of it is not read.
bool is_journal(const std::filesystem::path& file);

// Throws InputError if the file is a journal, or if it does not exist and its journal does. The message says
// how a recording is made of it.
void require_no_journal(const std::filesystem::path& file);

// Throws InputError if the journal of the target exists: nothing but its user may remove it.
void require_no_journal_beside(const std::filesystem::path& target);

struct JournalBlock {
  std::uint32_t kind = 0;
  std::string content;
};

// The journal exists from the constructor on, with its first block, until remove(). The destructor leaves it.
// It is locked, so that readers know that it grows; the lock ends with the process. Members throw InputError
// naming the target when the disk refuses; the blocks before remain whole.
class JournalWriter {
 public:
  // Throws InputError if the target is a folder, a pipe or a device, or has a journal already.
  JournalWriter(const std::filesystem::path& target, const JournalBlock& first);
  ~JournalWriter();
  JournalWriter(const JournalWriter&) = delete;
  JournalWriter& operator=(const JournalWriter&) = delete;

  // The system has the block afterwards: it outlasts the process, but not a power cut.
  void append(const JournalBlock& block);
  // The disk has every block that was appended before. May be called beside append(), from another thread.
  void sync() const;
  // Removes the file. A file that cannot be removed stays.
  void remove() noexcept;

  const std::filesystem::path& file() const { return file_; }

 private:
  void create(const JournalBlock& first);
  void give_name(const std::filesystem::path& temporary) const;
  void write(const std::string& bytes);
  [[noreturn]] void refuse(int error) const;

  const std::filesystem::path target_, file_;
  int descriptor_ = -1;
  std::uint64_t next_number_ = 0, size_ = 0;  // size_: up to the end of the last whole block
};

// Reads the blocks in order, up to the first one that is not whole: cut, changed or out of order.
class JournalReader {
 public:
  // Throws InputError naming the file when it is missing or no journal.
  explicit JournalReader(const std::filesystem::path& file);
  ~JournalReader();
  JournalReader(const JournalReader&) = delete;
  JournalReader& operator=(const JournalReader&) = delete;

  // The next block; none at the end, or where the next block is not whole. Throws InputError when the file
  // cannot be read.
  std::optional<JournalBlock> next();
  // Bytes behind the last block that next() returned, in a file of the size that it had at the beginning.
  std::uint64_t left() const { return size_ - at_; }
  // True while its writer lives.
  bool is_growing() const { return is_growing_; }
  // Takes back the last block that next() returned: its content is not what its kind says.
  void reject() { at_ = last_; }

 private:
  bool read(std::uint64_t from, void* bytes, std::size_t size) const;

  const std::filesystem::path file_;
  int descriptor_ = -1;
  bool is_growing_ = false;
  std::uint64_t size_ = 0, at_ = 0, last_ = 0, number_ = 0;
};

}  // namespace remote_touch
