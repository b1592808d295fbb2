// Commands as a shell takes them.
#pragma once

#include <string>
#include <vector>

namespace remote_touch {

// The words with spaces between them, each in single quotes where it needs them.
std::string shell_command(const std::vector<std::string>& words);

}  // namespace remote_touch
