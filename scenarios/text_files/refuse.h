// Refuses a file, with what is wrong with it in one line.
#pragma once

#include <string>
#include <type_traits>

#include "core/parameters/input_error.h"

namespace remote_touch {

// Throws InputError about the subject. The problem is given in parts: texts, and numbers, which are written
// as by std::to_string().
template <class... Parts>
[[noreturn]] void refuse(const std::string& subject, Parts... parts) {
  std::string problem;
  const auto add = [&problem](const auto& part) {
    if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(part)>>)
      problem += std::to_string(part);
    else
      problem += part;
  };
  (add(parts), ...);
  throw InputError(subject, problem);
}

}  // namespace remote_touch
