#include "tests/fuzz/fuzz_target.h"

#include <algorithm>
#include <stdexcept>

namespace remote_touch::fuzz {

std::vector<Target>& targets() {
  static std::vector<Target> list;
  return list;
}

void require(bool is_true, const char* what) {
  if (!is_true) throw std::logic_error(std::string("not true: ") + what);
}

void require_one_line(const std::string& message) {
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  require(!message.empty() && std::none_of(message.begin(), message.end(), is_control),
          "a refusal is one line");
  for (const char* of_a_library : {"json.exception", "std::", "basic_", "vector::", "locale::"})
    require(message.find(of_a_library) == std::string::npos, "no library speaks to the user");
}

}  // namespace remote_touch::fuzz
