#include "runners/commands/shell_command.h"

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
  for (const std::string& word : words) command += (command.empty() ? "" : " ") + quoted(word);
  return command;
}

std::vector<std::string> words_of(const std::string& command) {
  std::vector<std::string> words(1);
  bool inside = false;
  for (std::size_t i = 0; i < command.size(); ++i) {
    const char c = command[i];
    if (c == '\'')
      inside = !inside;
    else if (c == '\\' && !inside && i + 1 < command.size())
      words.back() += command[++i];
    else if (c == ' ' && !inside)
      words.emplace_back();
    else
      words.back() += c;
  }
  return words;
}

}  // namespace remote_touch
