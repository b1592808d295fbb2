// Errors in the text of a file, such as an experiment. The message begins with the name of the file.
#pragma once

#include <string>
#include <typeinfo>
#include <vector>

#include "core/parameters/input_error.h"

namespace remote_touch {

// An error in the text of a file. It begins with the name of that file.
class FileRefusal : public InputError {
 public:
  using InputError::InputError;
};

// Returns the line without its subject if that is `subject`; otherwise the whole line.
std::string without_subject(const std::string& subject, const std::string& line);

// Returns read(overrides), which reads the text of the file with overrides "key=value" on top of it. If
// read() throws InputError because the text is wrong, the message begins with the name of the file. The text
// is wrong if read() refuses it in the same words without overrides. A class of its own derived from
// InputError, such as that of a problem in Python, passes unchanged.
template <class Read>
auto with_file_in_refusal(const std::string& file, const std::vector<std::string>& overrides, Read&& read) {
  const auto line_of = [&](const InputError& error) { return without_subject(file, error.what()); };
  const auto is_refused_alone = [&](const std::string& line) {
    try {
      read(std::vector<std::string>());
      return false;
    } catch (const InputError& alone) {
      return line_of(alone) == line;
    }
  };
  try {
    return read(overrides);
  } catch (const InputError& error) {
    if (typeid(error) != typeid(InputError)) throw;
    const std::string line = line_of(error);
    if (overrides.empty() || is_refused_alone(line)) throw FileRefusal(file, line);
    throw InputError(line);
  }
}

}  // namespace remote_touch
