// Append-only files of blocks, for a recording that is still running. Every block that was appended can be
// read again, however the program ends.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace remote_touch {

// A journal begins with this line. The blocks follow, one after the other, in the byte order of x86-64. A
// block is
//   char[4] "RTb1", uint32 kind, uint64 number of the block (from 0), uint64 size of the content,
//   uint32 CRC-32 of the content, uint32 CRC-32 of the 28 bytes before, and then the content.
inline constexpr std::string_view kJournalOpening = "Remote Touch unfinished recording, format 1\n";

// Returns the journal of a file that is being recorded: FILE.unfinished. If FILE is a link, the journal is
// beside the file that it links to.
std::filesystem::path journal_of(const std::filesystem::path& target);

// True if the file begins with kJournalOpening. The rest of the file is not read.
bool is_journal(const std::filesystem::path& file);

// Throws InputError if the file is a journal, or if it does not exist but its journal does. The message names
// the command that makes a recording of the journal.
void require_no_journal(const std::filesystem::path& file);

// Throws InputError if the journal of the target exists, because only the user may remove it. Does not throw
// for a journal that nothing can use: one without a whole block after its first one, whose writer has ended.
void require_no_journal_beside(const std::filesystem::path& target);

struct JournalBlock {
  std::uint32_t kind = 0;
  std::string content;
};

// Creates a journal with its first block, and appends further blocks. The journal exists from the constructor
// until remove(); the destructor leaves it. The writer locks the file, so that readers know that it still
// grows. The lock ends with the process at the latest. Members throw InputError, which names the target, if
// the file cannot be written. The earlier blocks stay whole then. If the written part of a block cannot be
// removed, every later append() throws too, because its block could not be read.
class JournalWriter {
 public:
  // Replaces a journal that nothing can use. Throws InputError if the target is a folder, a pipe or a device,
  // or if it already has another journal.
  JournalWriter(const std::filesystem::path& target, const JournalBlock& first);
  ~JournalWriter();
  JournalWriter(const JournalWriter&) = delete;
  JournalWriter& operator=(const JournalWriter&) = delete;

  // Afterwards the operating system has the block: it survives the end of the process, but not a power cut.
  void append(const JournalBlock& block);
  // Writes every block that was appended before to the disk. Another thread may call it during append().
  void sync() const;
  // Removes the file. If that fails, the file stays.
  void remove() noexcept;

  const std::filesystem::path& file() const { return file_; }

 private:
  void create(const JournalBlock& first);
  void give_name(const std::filesystem::path& temporary) const;
  void write(const std::string& bytes);
  [[noreturn]] void refuse(int error) const;

  const std::filesystem::path target_, file_;
  int descriptor_ = -1;
  std::uint64_t next_number_ = 0, size_ = 0;  // size_: bytes up to the end of the last whole block
  int lasting_error_ = 0;                     // errno of the write whose part could not be removed
};

// Reads the blocks in order, up to the first one that is not whole: cut off, changed or out of order.
class JournalReader {
 public:
  // Throws InputError, which names the file, if it is missing, is no journal or cannot be read.
  explicit JournalReader(const std::filesystem::path& file);
  ~JournalReader();
  JournalReader(const JournalReader&) = delete;
  JournalReader& operator=(const JournalReader&) = delete;

  // Returns the next block. Returns nothing at the end, or if the next block is not whole. Throws InputError
  // if the file cannot be read.
  std::optional<JournalBlock> next();
  // Number of bytes after the last block that next() returned, up to the size that the file had in the
  // constructor.
  std::uint64_t left() const { return size_ - at_; }
  // True if a writer had the file open when this reader was constructed.
  bool is_growing() const { return is_growing_; }
  // True if it is certain that no writer had the file open then. A file system without locks leaves both
  // false.
  bool is_abandoned() const { return is_abandoned_; }
  // Undoes the last next(), because the content of its block is not valid for its kind. left() then includes
  // this block, and next() returns nothing.
  void reject() { at_ = last_; }

 private:
  bool read(std::uint64_t from, void* bytes, std::size_t size) const;

  const std::filesystem::path file_;
  int descriptor_ = -1;
  bool is_growing_ = false, is_abandoned_ = false;
  std::uint64_t size_ = 0, at_ = 0, last_ = 0, number_ = 0;
};

}  // namespace remote_touch
