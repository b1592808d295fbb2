// Arrays of numbers one after another, for a page to read: little endian, each at a multiple of eight bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/text_files/text_file.h"

namespace remote_touch {

// Position, type and length of an array in the bytes of PackedArrays.
struct PackedArray {
  std::size_t at = 0;        // first byte
  const char* type = "f64";  // f64, f32, i32, u32, u16 or u8
  std::size_t length = 0;    // numbers
};
Json json_of(const PackedArray& array);

class PackedArrays {
 public:
  PackedArray add(const std::vector<double>& values) { return append(values, "f64"); }
  PackedArray add(const std::vector<float>& values) { return append(values, "f32"); }
  PackedArray add(const std::vector<std::int32_t>& values) { return append(values, "i32"); }
  PackedArray add(const std::vector<std::uint32_t>& values) { return append(values, "u32"); }
  PackedArray add(const std::vector<std::uint16_t>& values) { return append(values, "u16"); }
  PackedArray add(const std::vector<std::uint8_t>& values) { return append(values, "u8"); }
  const std::string& bytes() const { return bytes_; }

 private:
  template <class T>
  PackedArray append(const std::vector<T>& values, const char* type) {
    bytes_.resize((bytes_.size() + 7) / 8 * 8);
    const std::size_t at = bytes_.size();
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    return {at, type, values.size()};
  }
  std::string bytes_;
};

}  // namespace remote_touch
