#include "scenarios/recordings/bags/bag_chunk.h"

#include <zlib.h>

#include <algorithm>

#include "core/parameters/input_error.h"

namespace remote_touch {
namespace {

constexpr std::size_t kPiece = 1u << 20;

std::uint32_t add_to_crc(std::uint32_t crc, const char* bytes, std::size_t size) {
  return static_cast<std::uint32_t>(
      crc32_z(crc, reinterpret_cast<const unsigned char*>(bytes), static_cast<z_size_t>(size)));
}

}  // namespace

BagChunk::BagChunk(const ByteFile& file, const ChunkPlace& place) : file_(file), place_(place) {
  if (!file.has(place.stored_at, place.stored_size))
    refuse("claims " + std::to_string(place.stored_size) + " bytes: more than the file has");
  decompressor_ = make_decompressor(place.compression, file.name());
  if (!decompressor_ && !place.compression.empty() && place.compression != "none")
    refuse("compression = \"" + place.compression.substr(0, 32) + "\": expected lz4, zstd, bz2 or none");
  if (!decompressor_ && place.size != place.stored_size)
    refuse("is not compressed, but its stored size and its decoded size differ");
  if (decompressor_ && place.size > kMaxBytes)
    refuse("claims " + std::to_string(place.size) + " bytes when decompressed: expected up to " +
           std::to_string(kMaxBytes));
}

void BagChunk::refuse(const std::string& problem) const {
  throw InputError(file_.name(), "the chunk at byte " + std::to_string(place_.record_at) + " " + problem);
}

// Decodes up to byte `end`. Memory grows with the bytes that are decoded, not with the size that the chunk
// claims.
void BagChunk::decode_until(std::uint64_t end) {
  while (decoded_.size() < end) {
    if (input_left_.empty() && input_at_ < place_.stored_size) {
      input_ = file_.bytes(place_.stored_at + input_at_,
                           std::min<std::uint64_t>(kPiece, place_.stored_size - input_at_));
      input_left_ = input_, input_at_ += input_.size();
    }
    const std::size_t before = decoded_.size(), left_before = input_left_.size();
    const auto more = static_cast<std::size_t>(std::min<std::uint64_t>(kPiece, place_.size - before));
    if (decoded_.capacity() < before + more)
      decoded_.reserve(static_cast<std::size_t>(std::min<std::uint64_t>(place_.size, 2 * (before + more))));
    decoded_.resize(before + more);
    const std::size_t got = decompressor_->decode(input_left_, decoded_.data() + before, more);
    decoded_.resize(before + got);
    crc_so_far_ = add_to_crc(crc_so_far_, decoded_.data() + before, got);
    if (got == 0 && input_left_.size() == left_before)
      refuse("ends after " + std::to_string(before) + " decompressed bytes: expected " +
             std::to_string(place_.size));
  }
}

std::string_view BagChunk::view(std::uint64_t at, std::uint64_t size) {
  if (at > place_.size || size > place_.size - at)
    refuse("has " + std::to_string(place_.size) + " bytes: expected " + std::to_string(size) + " at " +
           std::to_string(at));
  if (decompressor_) {
    decode_until(at + size);
    return std::string_view(decoded_).substr(at, size);
  }
  decoded_ = file_.bytes(place_.stored_at + at, size);
  return decoded_;
}

void BagChunk::check() {
  if (checked_) return;
  if (decompressor_) {
    decode_until(place_.size);
  } else if (place_.crc != 0) {
    std::string piece;
    for (std::uint64_t at = 0; at < place_.size; at += piece.size()) {
      piece = file_.bytes(place_.stored_at + at, std::min<std::uint64_t>(kPiece, place_.size - at));
      crc_so_far_ = add_to_crc(crc_so_far_, piece.data(), piece.size());
    }
  }
  if (place_.crc != 0 && place_.crc != crc_so_far_) refuse("is damaged: its CRC differs from the stated one");
  checked_ = true;
}

}  // namespace remote_touch
