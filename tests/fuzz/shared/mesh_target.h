// A mesh file of one kind, read in a child process with limits.
#pragma once

#include <string>
#include <string_view>

namespace remote_touch::fuzz {

void read_as_mesh(const std::string& name, std::string_view bytes);

}  // namespace remote_touch::fuzz
