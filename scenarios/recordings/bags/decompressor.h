// Decodes compressed bytes piece by piece, as they are needed: frames of LZ4 and Zstandard, and bzip2.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace remote_touch {

class Decompressor {
 public:
  explicit Decompressor(const std::string& subject) : subject_(subject) {}
  virtual ~Decompressor() = default;
  // Removes bytes from the front of `from`, writes up to `size` decoded bytes and returns their number.
  // Returns 0 only if it needs more bytes than `from` has, or if its frame has ended. Throws InputError about
  // the subject for damaged bytes.
  virtual std::size_t decode(std::string_view& from, char* to, std::size_t size) = 0;

 protected:
  const std::string subject_;
};

// kind: lz4, zstd or bz2. Returns null for another kind.
std::unique_ptr<Decompressor> make_decompressor(const std::string& kind, const std::string& subject);

}  // namespace remote_touch
