#include "tests/fuzz/shared/fuzz_target.h"

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

void require_one_line(const std::string& message, std::string_view bytes) {
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  require(!message.empty() && std::none_of(message.begin(), message.end(), is_control),
          "a refusal is one line");
  const auto has = [](const std::string& text, const char* word) {
    return text.find(word) != std::string::npos;
  };
  const std::string quoted = printable(std::string(bytes));
  for (const char* of_a_library :
       {"json.exception.", "std::bad_", "basic_string::_M", "basic_string::at", "basic_string::substr",
        "vector::_M", "map::at", "locale::facet", "std::vector larger", "std::get: ", "std::exception",
        "basic_string: construction", "basic_ios::clear"})
    require(!has(message, of_a_library) || has(quoted, of_a_library), "no library speaks to the user");
}

}  // namespace remote_touch::fuzz
