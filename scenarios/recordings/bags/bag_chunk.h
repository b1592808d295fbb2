// One chunk of a bag: a series of records that are compressed together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "scenarios/files/input_files.h"
#include "scenarios/recordings/bags/bag_file.h"

namespace remote_touch {

// Decodes compressed bytes piece by piece, as they are needed: frames of LZ4 and Zstandard, and bzip2.
// Removes bytes from the front of `from`, writes up to `size` decoded bytes and returns their number. Returns
// 0 only if it needs more bytes than `from` has, or if its frame has ended. Throws InputError for damaged
// bytes.
using Decompress = std::function<std::size_t(std::string_view& from, char* to, std::size_t size)>;

// Position and properties of a chunk, from its record.
struct ChunkPlace {
  std::uint64_t record_at = 0;                   // position of that record in the file
  std::uint64_t stored_at = 0, stored_size = 0;  // position and size of the bytes in the file
  std::uint64_t size = 0;                        // size of the records, decoded
  std::string compression;                       // empty, none, lz4, zstd or bz2
  std::uint32_t crc = 0;                         // CRC of the records, decoded; 0: not stated
  // The recorder ended before the chunk did: the records are those that the bytes give, and `size` is unused.
  bool is_open = false;
};

class BagChunk {
 public:
  static constexpr std::uint64_t kMaxBytes = 256u << 20;  // limit for the decoded size of a compressed chunk

  // `file` must outlive the chunk. Throws InputError about the file if it does not have the bytes, or the
  // compression is not known.
  BagChunk(const ByteFile& file, const ChunkPlace& place);

  std::uint64_t record_at() const { return place_.record_at; }
  std::uint64_t size() const { return place_.size; }  // bytes of its records
  // Returns `size` bytes of the records, from byte `at` on, valid until the next call. Decodes only as far as
  // needed and keeps the decoded bytes. Throws InputError if the bytes are beyond the end or damaged.
  std::string_view view(std::uint64_t at, std::uint64_t size);
  // Decodes the rest. Throws InputError if the file states a CRC and the records have another.
  void check();

 private:
  void decode_until(std::uint64_t end);
  void decode_open();
  template <class... Parts>
  [[noreturn]] void refuse_chunk(Parts... problem) const {
    refuse(file_.name(), "the chunk at byte ", place_.record_at, " ", problem...);
  }

  const ByteFile& file_;
  ChunkPlace place_;
  std::uint32_t crc_so_far_ = 0;
  Decompress decompress_;  // none: the records are stored as they are
  std::string decoded_;    // bytes decoded so far; if not compressed, those viewed last
  std::string input_;      // a piece of the compressed bytes
  std::string_view input_left_;
  std::uint64_t input_at_ = 0;  // number of compressed bytes read so far
  bool checked_ = false;
};

// The kinds of files whose records are in chunks, see open_bag(): .mcap and .bag.
std::unique_ptr<BagFile> open_mcap(const std::filesystem::path& file, const WantedTopic& wanted);
std::unique_ptr<BagFile> open_ros1_bag(const std::filesystem::path& file, const WantedTopic& wanted);

}  // namespace remote_touch
