// Two results of any kind, as text (content_text.h), parted by a line "---": read and compared.
#pragma once

#include <string_view>

namespace remote_touch::fuzz {

void compare_as_results(std::string_view bytes);

}  // namespace remote_touch::fuzz
