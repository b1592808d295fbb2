#include "scenarios/recordings/bag_file.h"

#include <bzlib.h>
#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <new>

#include "core/parameters/parameter.h"

namespace remote_touch {
namespace {

constexpr std::size_t kPiece = 1u << 20;

Decompress lz4(const std::string& subject) {
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION))) throw std::bad_alloc();
  const std::shared_ptr<LZ4F_dctx> context(made, LZ4F_freeDecompressionContext);
  return [subject, context](std::string_view& from, char* to, std::size_t size) {
    std::size_t taken = from.size();
    const std::size_t result = LZ4F_decompress(context.get(), to, &size, from.data(), &taken, nullptr);
    if (LZ4F_isError(result)) refuse(subject, "its LZ4 data are damaged: ", LZ4F_getErrorName(result));
    from.remove_prefix(taken);
    return size;
  };
}

Decompress zstd(const std::string& subject) {
  const std::shared_ptr<ZSTD_DCtx> context(ZSTD_createDCtx(), ZSTD_freeDCtx);
  if (!context) throw std::bad_alloc();
  return [subject, context](std::string_view& from, char* to, std::size_t size) {
    ZSTD_inBuffer in{from.data(), from.size(), 0};
    ZSTD_outBuffer out{to, size, 0};
    const std::size_t result = ZSTD_decompressStream(context.get(), &out, &in);
    if (ZSTD_isError(result)) refuse(subject, "its Zstandard data are damaged: ", ZSTD_getErrorName(result));
    from.remove_prefix(in.pos);
    return out.pos;
  };
}

Decompress bz2(const std::string& subject) {
  auto owned = std::make_unique<bz_stream>();
  if (BZ2_bzDecompressInit(owned.get(), 0, 0) != BZ_OK) throw std::bad_alloc();
  const std::shared_ptr<bz_stream> stream(owned.release(), [](bz_stream* ended) {
    BZ2_bzDecompressEnd(ended);
    delete ended;
  });
  return [subject, stream, ended = false](std::string_view& from, char* to, std::size_t size) mutable {
    if (ended) return std::size_t{0};
    stream->next_in = const_cast<char*>(from.data()), stream->avail_in = static_cast<unsigned>(from.size());
    stream->next_out = to, stream->avail_out = static_cast<unsigned>(size);
    const int result = BZ2_bzDecompress(stream.get());
    if (result == BZ_MEM_ERROR) throw std::bad_alloc();
    if (result != BZ_OK && result != BZ_STREAM_END)
      refuse(subject, "its bzip2 data are damaged: error ", result);
    ended = result == BZ_STREAM_END;
    from.remove_prefix(from.size() - stream->avail_in);
    return size - stream->avail_out;
  };
}

Decompress decompress(const std::string& kind, const std::string& subject) {
  return kind == "lz4"    ? lz4(subject)
         : kind == "zstd" ? zstd(subject)
         : kind == "bz2"  ? bz2(subject)
                          : nullptr;
}

}  // namespace

BagChunk::BagChunk(const ByteFile& file, const ChunkPlace& place) : file_(file), place_(place) {
  if (!file.has(place.stored_at, place.stored_size))
    refuse_chunk("claims ", place.stored_size, " bytes: more than the file has");
  decompress_ = decompress(place.compression, file.name());
  if (!decompress_ && !place.compression.empty() && place.compression != "none")
    refuse_chunk("compression = \"", place.compression.substr(0, 32), "\": expected lz4, zstd, bz2 or none");
  if (place.is_open) {
    decode_open();
    return;
  }
  if (!decompress_ && place.size != place.stored_size)
    refuse_chunk("is not compressed, but its stored size and its decoded size differ");
  if (decompress_ && place.size > kMaxBytes)
    refuse_chunk("claims ", place.size, " bytes when decompressed: expected up to ", kMaxBytes);
}

// Decodes until the bytes end, or until they are no longer compressed data. Sets the size to what was
// decoded.
void BagChunk::decode_open() {
  place_.size = decompress_ ? kMaxBytes : place_.stored_size;
  if (!decompress_) return;
  try {
    decode_until(kMaxBytes);
  } catch (const InputError&) {
    place_.size = decoded_.size();
  }
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
    std::size_t got = 0;
    try {
      got = decompress_(input_left_, decoded_.data() + before, more);
    } catch (const InputError&) {
      decoded_.resize(before);
      throw;
    }
    decoded_.resize(before + got);
    const auto* new_bytes = reinterpret_cast<const unsigned char*>(decoded_.data() + before);
    crc_so_far_ = static_cast<std::uint32_t>(crc32_z(crc_so_far_, new_bytes, got));
    if (got == 0 && input_left_.size() == left_before)
      refuse_chunk("ends after ", before, " decompressed bytes: expected ", place_.size);
  }
}

std::string_view BagChunk::view(std::uint64_t at, std::uint64_t size) {
  if (at > place_.size || size > place_.size - at)
    refuse_chunk("has ", place_.size, " bytes: expected ", size, " at ", at);
  if (decompress_) {
    decode_until(at + size);
    return std::string_view(decoded_).substr(at, size);
  }
  decoded_ = file_.bytes(place_.stored_at + at, size);
  return decoded_;
}

void BagChunk::check() {
  if (checked_) return;
  if (decompress_) {
    decode_until(place_.size);
  } else if (place_.crc != 0) {
    crc_so_far_ = file_.crc(place_.stored_at, place_.stored_at + place_.size);
  }
  if (place_.crc != 0 && place_.crc != crc_so_far_)
    refuse_chunk("is damaged: its CRC differs from the stated one");
  checked_ = true;
}

}  // namespace remote_touch
