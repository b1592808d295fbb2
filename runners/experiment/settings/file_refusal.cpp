#include "runners/experiment/settings/file_refusal.h"

#include <algorithm>
#include <cctype>

namespace remote_touch {

namespace {

// True if the line begins with the path and the name does not go on: "renderer.r1" is not the subject of
// "renderer.r1_m = 7".
bool has_subject(const std::string& line, const std::string& path) {
  if (path.empty() || !line.starts_with(path)) return false;
  const char next = line.size() > path.size() ? line[path.size()] : ' ';
  return !std::isalnum(static_cast<unsigned char>(next)) && next != '_';
}

}  // namespace

std::string without_subject(const std::string& subject, const std::string& line) {
  const std::string begin = InputError(subject, "").what();
  return line.starts_with(begin) ? line.substr(begin.size()) : line;
}

bool refuses_override(const std::string& line, const std::vector<std::string>& overrides) {
  const std::string option = "--set ";
  const std::string setting = line.starts_with(option) ? line.substr(option.size()) : line;
  return std::any_of(overrides.begin(), overrides.end(), [&](const std::string& assignment) {
    return has_subject(setting, printable(assignment.substr(0, assignment.find('='))));
  });
}

}  // namespace remote_touch
