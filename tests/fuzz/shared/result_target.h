// Two results of any kind, as text (content_text.h), separated by a line "---": they are read and compared.
#pragma once

#include <string_view>

namespace remote_touch::fuzz {

void compare_as_results(std::string_view bytes);

}  // namespace remote_touch::fuzz
