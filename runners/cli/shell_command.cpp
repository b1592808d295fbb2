#include "runners/cli/shell_command.h"

#include <algorithm>

namespace remote_touch {

namespace {

bool is_plain(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) ||
         std::string("_-./=,:+%@").find(c) != std::string::npos;
}

std::string quoted(const std::string& word) {
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return word;
  std::string safe = "'";
  for (const char c : word) safe += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return safe + "'";
}

}  // namespace

std::string shell_command(const std::vector<std::string>& words) {
  std::string command;
  for (const std::string& word : words) command.append(command.empty() ? "" : " ").append(quoted(word));
  return command;
}

std::vector<std::string> words_of(const std::string& command) {
  return commands_of(command).front();
}

std::vector<std::vector<std::string>> commands_of(const std::string& text) {
  std::vector<std::vector<std::string>> commands = {{""}};
  bool inside = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\'')
      inside = !inside;
    else if (c == '\\' && !inside && i + 1 < text.size())
      commands.back().back() += text[++i];
    else if (c == ' ' && !inside)
      commands.back().emplace_back();
    else if (text.compare(i, 2, "; ") == 0 && !inside)
      commands.push_back({""}), ++i;
    else
      commands.back().back() += c;
  }
  return commands;
}

}  // namespace remote_touch
