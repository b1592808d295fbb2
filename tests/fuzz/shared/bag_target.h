// What the targets of bags share: a file is opened, and what it has is read as the program does.
#pragma once

#include <string>
#include <string_view>

namespace remote_touch::fuzz {

// name: of the file, with the ending of its kind.
void read_bag(const std::string& name, std::string_view bytes);

}  // namespace remote_touch::fuzz
