// Reads the bytes of one message of ROS, value after value. No length in them is trusted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace remote_touch {

// Encoding of a message's values. ROS 2 uses CDR: a header of 4 bytes that states the byte order, then values
// aligned to their size. ROS 1 uses little-endian values without gaps.
enum class WireFormat { cdr, ros1 };

class MessageCursor {
 public:
  // bytes must outlive the cursor and all views that it returns. subject: what an InputError is about. Throws
  // InputError if the header of CDR is missing or of another encoding.
  MessageCursor(std::string_view bytes, WireFormat format, const std::string& subject);

  WireFormat format() const { return format_; }
  const std::string& subject() const { return subject_; }

  // Each reads one value. Throws InputError if the message ends before the value does.
  std::uint8_t u8() { return static_cast<std::uint8_t>(take(1)); }
  std::uint16_t u16() { return static_cast<std::uint16_t>(take(2)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(take(4)); }
  std::uint64_t u64() { return take(8); }
  std::int32_t i32() { return static_cast<std::int32_t>(u32()); }
  float f32();
  double f64();
  std::string text();
  // Reads the length of a sequence whose elements have at least min_bytes each. Throws InputError if the
  // bytes left cannot hold as many elements.
  std::uint32_t count(std::size_t min_bytes);
  std::string_view bytes();                 // a sequence of bytes: its length in 32 bits first
  std::string_view view(std::size_t size);  // size bytes as they are
  std::size_t left() const { return bytes_.size() - at_; }

 private:
  std::uint64_t take(std::size_t size);

  std::string_view bytes_;
  WireFormat format_;
  std::string subject_;
  std::size_t at_ = 0, origin_ = 0;
  bool big_endian_ = false;
};

}  // namespace remote_touch
