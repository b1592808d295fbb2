// The bytes of a page's messages, see live_view.h.
#pragma once

#include <cstdint>
#include <string>

#include "core/points/vector.h"
#include "tests/support/test_files.h"

namespace remote_touch {

inline std::string page_bytes(char kind, std::uint32_t number) {
  return std::string{kind, 0, 0, 0} + raw(number);
}

inline std::string hand_bytes(const Vec3& p, std::uint32_t buttons = 0,
                              const Eigen::Vector4d& wxyz = {1, 0, 0, 0}) {
  std::string bytes = page_bytes(1, buttons);
  for (const double number : p) bytes += raw(number);
  for (const double number : wxyz) bytes += raw(number);
  return bytes;
}

inline std::string acknowledgement_bytes(std::uint32_t number) {
  return page_bytes(2, number);
}

inline std::string hand_request_bytes() {
  return page_bytes(4, 0);
}

// One change of a parameter, as it follows the head page_bytes(3, count).
inline std::string change_bytes(std::int32_t parameter, double value, std::uint32_t padding = 0) {
  return raw(parameter) + raw(padding) + raw(value);
}

}  // namespace remote_touch
