#include "runners/experiment/settings/file_refusal.h"

namespace remote_touch {

std::string without_subject(const std::string& subject, const std::string& line) {
  const std::string begin = InputError(subject, "").what();
  return line.starts_with(begin) ? line.substr(begin.size()) : line;
}

}  // namespace remote_touch
