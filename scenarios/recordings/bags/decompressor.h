// Compressed bytes, decoded piece by piece as they are needed: frames of LZ4 and Zstandard, and bzip2.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace remote_touch {

class Decompressor {
 public:
  virtual ~Decompressor() = default;
  // Takes bytes from the front of `from` and writes up to `size` decoded ones; returns how many. 0 only when
  // it needs more than `from` has, or its frame has ended. Throws InputError about the subject for damaged
  // bytes.
  virtual std::size_t decode(std::string_view& from, char* to, std::size_t size) = 0;
};

// kind: lz4, zstd or bz2; null for others.
std::unique_ptr<Decompressor> make_decompressor(const std::string& kind, const std::string& subject);

}  // namespace remote_touch
