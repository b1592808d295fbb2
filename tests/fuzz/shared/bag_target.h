// Shared by the targets of bags: opens a file and reads its content as the program does.
#pragma once

#include <string>
#include <string_view>

namespace remote_touch::fuzz {

// name is the name of the file, with the ending of its kind.
void read_bag(const std::string& name, std::string_view bytes);

}  // namespace remote_touch::fuzz
