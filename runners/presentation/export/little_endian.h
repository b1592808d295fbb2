// Writes numbers one after another, as files store them: little-endian, without gaps.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>

namespace remote_touch {

static_assert(std::endian::native == std::endian::little);

template <class Number>
void put(std::string& bytes, Number number) {
  static_assert(std::is_arithmetic_v<Number>);
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

}  // namespace remote_touch
