#include "scenarios/recordings/bags/message_cursor.h"

#include <bit>

#include "scenarios/text_files/refuse.h"

namespace remote_touch {

MessageCursor::MessageCursor(std::string_view bytes, WireFormat format, const std::string& subject)
    : bytes_(bytes), format_(format), subject_(subject) {
  if (format_ == WireFormat::ros1) return;
  const std::string_view header = view(4);
  const unsigned kind = static_cast<unsigned char>(header[0]) << 8 | static_cast<unsigned char>(header[1]);
  if (kind > 1) refuse(subject_, "encapsulation = ", kind, ": expected 0 or 1, plain CDR");
  big_endian_ = kind == 0;
  origin_ = at_;
}

std::string_view MessageCursor::view(std::size_t size) {
  if (size > bytes_.size() - at_)
    refuse(subject_, "ends after ", bytes_.size(), " bytes: expected ", size, " more at byte ", at_);
  at_ += size;
  return bytes_.substr(at_ - size, size);
}

std::uint64_t MessageCursor::take(std::size_t size) {
  if (format_ == WireFormat::cdr) view((size - (at_ - origin_) % size) % size);
  const std::string_view stored = view(size);
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i)
    value = value << 8 | static_cast<unsigned char>(stored[big_endian_ ? i : size - 1 - i]);
  return value;
}

float MessageCursor::f32() {
  return std::bit_cast<float>(u32());
}

double MessageCursor::f64() {
  return std::bit_cast<double>(take(8));
}

std::string MessageCursor::text() {
  std::string_view stored = view(u32());
  if (format_ == WireFormat::cdr && stored.ends_with('\0')) stored.remove_suffix(1);
  return std::string(stored);
}

std::uint32_t MessageCursor::count(std::size_t min_bytes) {
  const std::uint32_t claimed = u32();
  const std::size_t left = bytes_.size() - at_;
  if (claimed > left / min_bytes)
    refuse(subject_, "claims ", claimed, " elements: the ", left, " bytes left hold at most ",
           left / min_bytes);
  return claimed;
}

std::string_view MessageCursor::bytes() {
  return view(u32());
}

}  // namespace remote_touch
