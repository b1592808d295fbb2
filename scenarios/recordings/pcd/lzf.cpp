#include "scenarios/recordings/pcd/lzf.h"

#include <cstring>
#include <utility>

#include "core/parameters/input_error.h"

namespace remote_touch {
namespace {

// A block being expanded: in_ bytes of it are read, the first out_ bytes of raw_ are written.
class LzfBlock {
 public:
  LzfBlock(const std::string& file, std::string_view block, std::size_t raw_size)
      : file_(file), block_(block), raw_(raw_size) {}

  std::vector<char> expand();

 private:
  InputError damaged() const;
  std::size_t next_byte();
  void copy_literals(std::size_t length);
  void copy_back(std::size_t distance, std::size_t length);

  const std::string& file_;
  const std::string_view block_;
  std::vector<char> raw_;
  std::size_t in_ = 0, out_ = 0;
};

InputError LzfBlock::damaged() const {
  return InputError(file_, "damaged LZF block at byte " + std::to_string(in_) + " of " +
                               std::to_string(block_.size()) + ": " + std::to_string(out_) + " of " +
                               std::to_string(raw_.size()) + " bytes expanded");
}

std::size_t LzfBlock::next_byte() {
  if (in_ == block_.size()) throw damaged();
  return static_cast<unsigned char>(block_[in_++]);
}

void LzfBlock::copy_literals(std::size_t length) {
  if (length > block_.size() - in_ || length > raw_.size() - out_) throw damaged();
  std::memcpy(raw_.data() + out_, block_.data() + in_, length);
  in_ += length, out_ += length;
}

// Byte by byte: a run may overlap itself, which repeats the last distance bytes.
void LzfBlock::copy_back(std::size_t distance, std::size_t length) {
  if (distance > out_ || length > raw_.size() - out_) throw damaged();
  for (const std::size_t end = out_ + length; out_ < end; ++out_) raw_[out_] = raw_[out_ - distance];
}

// A control byte c < 32 starts c + 1 literal bytes. Any other starts a back reference of (c >> 5) + 2 bytes,
// to which one more byte is added if c >> 5 = 7; c & 31 (high) and the next byte (low) are its distance - 1.
std::vector<char> LzfBlock::expand() {
  while (in_ < block_.size()) {
    const std::size_t control = next_byte();
    if (control < 32) {
      copy_literals(control + 1);
      continue;
    }
    std::size_t length = (control >> 5) + 2;
    if (length == 9) length += next_byte();
    const std::size_t distance = ((control & 31) << 8) + next_byte() + 1;
    copy_back(distance, length);
  }
  if (out_ != raw_.size()) throw damaged();
  return std::move(raw_);
}

}  // namespace

std::vector<char> lzf_expand(const std::string& file, std::string_view block, std::size_t raw_size) {
  return LzfBlock(file, block, raw_size).expand();
}

}  // namespace remote_touch
