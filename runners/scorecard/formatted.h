// printf into a std::string.
#pragma once

#include <cstdio>
#include <string>

namespace remote_touch {

// pre: the result is shorter than 256 characters.
template <class... Values>
std::string formatted(const char* form, Values... values) {
  char text[256];
  std::snprintf(text, sizeof text, form, values...);
  return text;
}

}  // namespace remote_touch
