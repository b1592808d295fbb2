// SHA-256, the digest of results, and the seal of a file.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/trace/columns.h"

namespace remote_touch {

// SHA-256, for digests of results, of stored files and of input files.
class Sha256 {
 public:
  Sha256();
  void add(const void* data, std::size_t size);
  std::string hex();  // 64 hexadecimal digits; call once, at the end

 private:
  std::shared_ptr<void> state_;
};

// Reads bytes from an offset of an open file on, as many as there are, up to `size`. Returns their number, or
// -1 with errno set if the file cannot be read.
ssize_t read_all(int descriptor, void* to, std::size_t size, off_t from);
// Throws the InputError of a file that cannot be read. error: the errno of the call that failed.
[[noreturn]] void refuse_reading(const std::filesystem::path& file, int error);

// SHA-256 of `before`, followed by the bytes of a file from the offset `from` on. Throws InputError if the
// file cannot be read.
std::string sha256_of_file(const std::filesystem::path& file, std::size_t from = 0,
                           std::string_view before = {});

// The digest of results: columns equal bit for bit have equal digests.

// SHA-256 over name, width and little-endian values of each column in order, as 64 hexadecimal digits. Names
// and texts each end with a zero byte. The name of a table precedes its columns.
std::string digest(const std::vector<Column>& columns);
std::string digest(const std::vector<Table>& tables);

// The same digest of columns whose values come in blocks.
class ColumnDigest {
 public:
  ColumnDigest();
  ~ColumnDigest();
  void begin(const std::string& name, int width);  // begins the next column
  void add(const Values& values);                  // the next values of the column
  std::string text();                              // call once, at the end

 private:
  std::unique_ptr<Sha256> hash_;
};

// The seal of a finished result: HDF5 keeps the first 512 bytes of a file for its user (the "user block"),
// which holds the SHA-256 of all that follows. So a changed byte anywhere is found before the HDF5 library,
// which checksums only the values of long columns, reads the file.

inline constexpr std::string_view kResultOpening =
    "Remote Touch result. HDF5 begins at byte 512; SHA-256 from there on:\n";
inline constexpr std::size_t kSealBlockSize = 512;  // the smallest user block there is

// Returns the image of an HDF5 file with the seal in front of it, as h5jam adds a user block. The library
// finds the start of the HDF5 part and counts offsets from there.
std::vector<char> with_seal(const std::vector<char>& image);

// Writes a new file: the seal, then the image of an HDF5 file on the disk. The bytes are those of
// with_seal(). Throws std::exception with the reason if a file cannot be read or written.
void write_sealed_copy(const std::filesystem::path& image, const std::filesystem::path& sealed);

// Seals a finished file in place. Throws std::exception with the reason if it cannot be read or written. pre:
// the file has a user block of kSealBlockSize bytes.
void write_seal(const std::filesystem::path& file);

// Returns the first `size` bytes of a file. The result is filled up with zeros if the file is shorter or
// cannot be read.
std::string opening_of(const std::filesystem::path& file, std::size_t size);

// True if a file begins as a finished result does. The rest of the file is not read.
bool has_result_header(const std::filesystem::path& file);

// valid: every byte is as it was written, except the bytes that was_opened_for_writing() allows to differ.
enum class SealState { valid, absent, broken };
// Throws InputError when the file cannot be read.
SealState seal_state_of(const std::filesystem::path& file);

// True if another program opened a finished result for writing and changed nothing. The HDF5 library then
// rewrites two addresses in the first block of the file. The SHA-256 holds with the original addresses.
// Throws InputError when the file cannot be read.
bool was_opened_for_writing(const std::filesystem::path& file);

}  // namespace remote_touch
