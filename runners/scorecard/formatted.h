// printf into a text.
#pragma once

#include <cstdio>
#include <string>

namespace remote_touch {

// pre: what comes out is shorter than 256 characters.
template <class... Values>
std::string formatted(const char* form, Values... values) {
  char text[256];
  std::snprintf(text, sizeof text, form, values...);
  return text;
}

}  // namespace remote_touch
