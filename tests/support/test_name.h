// Names of parameters as GoogleTest accepts them: with letters, digits and underscores only.
#pragma once

#include <cctype>
#include <string>

namespace remote_touch {

inline std::string test_name(std::string name) {
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

}  // namespace remote_touch
