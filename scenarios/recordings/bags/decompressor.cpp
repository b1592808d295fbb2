#include "scenarios/recordings/bags/decompressor.h"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <new>

#include "scenarios/text_files/refuse.h"

namespace remote_touch {
namespace {

class Lz4Decompressor final : public Decompressor {
 public:
  explicit Lz4Decompressor(const std::string& subject) : Decompressor(subject) {
    if (LZ4F_isError(LZ4F_createDecompressionContext(&context_, LZ4F_VERSION))) throw std::bad_alloc();
  }
  ~Lz4Decompressor() override { LZ4F_freeDecompressionContext(context_); }

  std::size_t decode(std::string_view& from, char* to, std::size_t size) override {
    std::size_t written = size, taken = from.size();
    const std::size_t result = LZ4F_decompress(context_, to, &written, from.data(), &taken, nullptr);
    if (LZ4F_isError(result)) refuse(subject_, "its LZ4 data are damaged: ", LZ4F_getErrorName(result));
    from.remove_prefix(taken);
    return written;
  }

 private:
  LZ4F_dctx* context_ = nullptr;
};

class ZstdDecompressor final : public Decompressor {
 public:
  explicit ZstdDecompressor(const std::string& subject) : Decompressor(subject) {
    if (!context_) throw std::bad_alloc();
  }
  ~ZstdDecompressor() override { ZSTD_freeDCtx(context_); }

  std::size_t decode(std::string_view& from, char* to, std::size_t size) override {
    ZSTD_inBuffer in{from.data(), from.size(), 0};
    ZSTD_outBuffer out{to, size, 0};
    const std::size_t result = ZSTD_decompressStream(context_, &out, &in);
    if (ZSTD_isError(result)) refuse(subject_, "its Zstandard data are damaged: ", ZSTD_getErrorName(result));
    from.remove_prefix(in.pos);
    return out.pos;
  }

 private:
  ZSTD_DCtx* const context_ = ZSTD_createDCtx();
};

class Bz2Decompressor final : public Decompressor {
 public:
  explicit Bz2Decompressor(const std::string& subject) : Decompressor(subject) {
    if (BZ2_bzDecompressInit(&stream_, 0, 0) != BZ_OK) throw std::bad_alloc();
  }
  ~Bz2Decompressor() override { BZ2_bzDecompressEnd(&stream_); }

  std::size_t decode(std::string_view& from, char* to, std::size_t size) override {
    if (ended_) return 0;
    stream_.next_in = const_cast<char*>(from.data()), stream_.avail_in = static_cast<unsigned>(from.size());
    stream_.next_out = to, stream_.avail_out = static_cast<unsigned>(size);
    const int result = BZ2_bzDecompress(&stream_);
    if (result == BZ_MEM_ERROR) throw std::bad_alloc();
    if (result != BZ_OK && result != BZ_STREAM_END)
      refuse(subject_, "its bzip2 data are damaged: error ", result);
    ended_ = result == BZ_STREAM_END;
    from.remove_prefix(from.size() - stream_.avail_in);
    return size - stream_.avail_out;
  }

 private:
  bz_stream stream_{};
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<Decompressor> make_decompressor(const std::string& kind, const std::string& subject) {
  if (kind == "lz4") return std::make_unique<Lz4Decompressor>(subject);
  if (kind == "zstd") return std::make_unique<ZstdDecompressor>(subject);
  if (kind == "bz2") return std::make_unique<Bz2Decompressor>(subject);
  return nullptr;
}

}  // namespace remote_touch
