// Commands as text for a shell.
#pragma once

#include <string>
#include <vector>

namespace remote_touch {

// Returns the words with spaces between them. A word is in single quotes if it needs them.
std::string shell_command(const std::vector<std::string>& words);

}  // namespace remote_touch
