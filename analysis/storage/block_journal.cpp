#include "analysis/storage/block_journal.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <bit>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <utility>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/digest.h"
#include "analysis/storage/other_processes.h"
#include "core/parameters/parameter.h"

namespace remote_touch {

namespace {

static_assert(std::endian::native == std::endian::little);

constexpr const char* kEnding = ".unfinished";

struct BlockHeader {
  char mark[4] = {'R', 'T', 'b', '1'};
  std::uint32_t kind = 0;
  std::uint64_t number = 0, size = 0;
  std::uint32_t content_crc = 0, header_crc = 0;
};
static_assert(sizeof(BlockHeader) == 32);

std::uint32_t crc_of(const void* bytes, std::size_t size) {
  return static_cast<std::uint32_t>(::crc32_z(0, static_cast<const Bytef*>(bytes), size));
}

std::uint32_t crc_of(const BlockHeader& header) {
  return crc_of(&header, offsetof(BlockHeader, header_crc));
}

std::string bytes_of(const JournalBlock& block, std::uint64_t number) {
  BlockHeader header;
  header.kind = block.kind, header.number = number, header.size = block.content.size();
  header.content_crc = crc_of(block.content.data(), block.content.size());
  header.header_crc = crc_of(header);
  std::string bytes(reinterpret_cast<const char*>(&header), sizeof header);
  return bytes += block.content;
}

bool is_header(const BlockHeader& header, std::uint64_t number, std::uint64_t room) {
  return std::memcmp(header.mark, BlockHeader{}.mark, sizeof header.mark) == 0 &&
         header.header_crc == crc_of(header) && header.number == number && header.size <= room;
}

std::string way_to_recover(const std::filesystem::path& journal) {
  return "`remote-touch recover " + journal.string() + " -o FILE`";
}

// True for an error of a file system without hard links, such as FAT.
bool has_no_links(int error) {
  return error == EPERM || error == EOPNOTSUPP || error == ENOSYS || error == EMLINK;
}

[[noreturn]] void refuse_beside(const std::filesystem::path& journal) {
  throw InputError(journal.string(),
                   "exists, an earlier recording that did not end: use another name for the new one, or "
                   "recover it with " +
                       way_to_recover(journal) + " and remove it");
}

// Replaces a useless journal. Of several writers that meet it, only the one that holds its lock may do so.
// Returns 0, or the errno; EEXIST: another writer was faster.
int replace_useless(const std::filesystem::path& journal, const std::filesystem::path& by) {
  const int old = ::open(journal.c_str(), O_RDONLY | O_CLOEXEC);
  int error = old < 0 && errno != ENOENT ? errno : 0;
  if (old >= 0) {
    const int locked = lock_error(old, LOCK_EX | LOCK_NB);
    struct stat judged {
    }, named{};
    const bool is_same = ::fstat(old, &judged) == 0 && ::stat(journal.c_str(), &named) == 0 &&
                         judged.st_ino == named.st_ino && judged.st_dev == named.st_dev;
    if ((locked != 0 && !has_no_locks(locked)) || !is_same) error = EEXIST;
  }
  if (error == 0 && ::rename(by.c_str(), journal.c_str()) != 0) error = errno;
  if (old >= 0) ::close(old);
  return error;
}

// True if nothing can be recovered from the journal: its writer was killed before the second block was whole.
bool is_useless(const std::filesystem::path& journal) {
  if (!is_journal(journal)) return false;
  JournalReader reader(journal);
  return reader.is_abandoned() && (!reader.next() || !reader.next());
}

}  // namespace

std::filesystem::path journal_of(const std::filesystem::path& target) {
  return resolved(target).string() + kEnding;
}

bool is_journal(const std::filesystem::path& file) {
  std::error_code unreachable;  // reading a pipe would block
  return std::filesystem::is_regular_file(file, unreachable) &&
         opening_of(file, kJournalOpening.size()) == kJournalOpening;
}

void require_no_journal(const std::filesystem::path& file) {
  if (is_journal(file))
    throw InputError(file.string(), "is an unfinished recording: expected a file that " +
                                        way_to_recover(file) + " makes from it");
  std::error_code unreachable;
  const std::filesystem::path journal = file.string() + kEnding;
  if (!std::filesystem::exists(file, unreachable) && is_journal(journal))
    throw InputError(file.string(),
                     "no such file, but its unfinished recording is there: expected a file that " +
                         way_to_recover(journal) + " makes from it");
}

void require_no_journal_beside(const std::filesystem::path& target) {
  const std::filesystem::path journal = journal_of(target);
  std::error_code unreachable;
  if (!std::filesystem::exists(std::filesystem::symlink_status(journal, unreachable))) return;
  if (!is_useless(journal)) refuse_beside(journal);
}

JournalWriter::JournalWriter(const std::filesystem::path& target, const JournalBlock& first)
    : target_(target), file_(journal_of(target)) {
  require_writable(target);
  require_no_device(target);
  require_no_journal_beside(target);
  try {
    create(first);
  } catch (...) {  // the destructor does not run for a constructor that throws
    if (descriptor_ >= 0) ::close(descriptor_);
    throw;
  }
}

JournalWriter::~JournalWriter() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

// The file gets its name only when its first block is whole, because a journal without a block is useless.
void JournalWriter::create(const JournalBlock& first) {
  const std::filesystem::path temporary = temporary_of(target_);
  descriptor_ = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) refuse(errno);
  try {
    const int error = lock_error(descriptor_, LOCK_EX | LOCK_NB);
    if (error != 0 && !has_no_locks(error)) refuse(error);
    write(std::string(kJournalOpening) + bytes_of(first, next_number_++));
    sync();
    give_name(temporary);
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
  flush_folder(file_);
}

// Gives the file its name, unless a file with that name exists that is of use.
void JournalWriter::give_name(const std::filesystem::path& temporary) const {
  if (::link(temporary.c_str(), file_.c_str()) == 0) {
    ::unlink(temporary.c_str());
    return;
  }
  const int error = errno;
  require_no_journal_beside(target_);
  if (error != EEXIST && !has_no_links(error)) refuse(error);
  const int replacing = replace_useless(file_, temporary);
  if (replacing == EEXIST) refuse_beside(file_);
  if (replacing != 0) refuse(replacing);
}

void JournalWriter::refuse(int error) const {
  refuse_writing(target_, error, "a writable folder with free space");
}

// Removes the written part of a block for which there is no room. If that fails, readers ignore this part and
// all that is behind it, so nothing more is written.
void JournalWriter::write(const std::string& bytes) {
  if (lasting_error_ != 0) refuse(lasting_error_);
  std::size_t done = 0;
  if (const int error = write_all(descriptor_, bytes.data(), bytes.size(), done); error != 0) {
    if (done > 0 && (::ftruncate(descriptor_, static_cast<off_t>(size_)) != 0 ||
                     ::lseek(descriptor_, static_cast<off_t>(size_), SEEK_SET) < 0))
      lasting_error_ = error;
    refuse(error);
  }
  size_ += bytes.size();
}

void JournalWriter::append(const JournalBlock& block) {
  write(bytes_of(block, next_number_));
  ++next_number_;
}

void JournalWriter::sync() const {
  if (::fdatasync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) refuse(errno);
}

void JournalWriter::remove() noexcept {
  if (descriptor_ < 0) return;
  ::unlink(file_.c_str());
  ::close(std::exchange(descriptor_, -1));
}

JournalReader::JournalReader(const std::filesystem::path& file) : file_(file) {
  std::error_code unreachable;
  if (!std::filesystem::exists(file, unreachable))
    throw InputError(file.string(), "no such file: expected a recording");
  if (!is_journal(file)) {
    const bool has_one = is_journal(file.string() + kEnding);
    throw InputError(file.string(), "is not an unfinished recording: expected " +
                                        (has_one ? file.string() : std::string("FILE")) + kEnding +
                                        ", which remote-touch live --record leaves when it is interrupted");
  }
  descriptor_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat there = {};
  if (descriptor_ < 0 || ::fstat(descriptor_, &there) != 0) {
    const int error = errno;
    if (descriptor_ >= 0) ::close(descriptor_);
    refuse_reading(file, error);
  }
  const int lock = lock_error(descriptor_, LOCK_SH | LOCK_NB);
  is_growing_ = lock == EWOULDBLOCK, is_abandoned_ = lock == 0;
  size_ = static_cast<std::uint64_t>(there.st_size);
  at_ = last_ = kJournalOpening.size();
}

JournalReader::~JournalReader() {
  ::close(descriptor_);
}

// Returns false if the file ends before.
bool JournalReader::read(std::uint64_t from, void* bytes, std::size_t size) const {
  const ssize_t found = read_all(descriptor_, bytes, size, static_cast<off_t>(from));
  if (found < 0) refuse_reading(file_, errno);
  return static_cast<std::size_t>(found) == size;
}

std::optional<JournalBlock> JournalReader::next() {
  BlockHeader header;
  const std::uint64_t room = left();
  if (room < sizeof header || !read(at_, &header, sizeof header)) return {};
  if (!is_header(header, number_, room - sizeof header)) return {};
  JournalBlock block{header.kind, std::string(static_cast<std::size_t>(header.size), '\0')};
  if (!read(at_ + sizeof header, block.content.data(), block.content.size())) return {};
  if (header.content_crc != crc_of(block.content.data(), block.content.size())) return {};
  last_ = at_;
  at_ += sizeof header + header.size;
  ++number_;
  return block;
}

}  // namespace remote_touch
