// Commands as a shell takes them, and back.
#pragma once

#include <string>
#include <vector>

namespace remote_touch {

// The words with spaces between them, each in single quotes where it needs them.
std::string shell_command(const std::vector<std::string>& words);

// The words of what shell_command made; not for other texts.
std::vector<std::string> words_of(const std::string& command);
// The words of each of such commands with "; " between them.
std::vector<std::vector<std::string>> commands_of(const std::string& text);

}  // namespace remote_touch
