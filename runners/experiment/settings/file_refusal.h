// Errors in the text of a file, such as an experiment. The message begins with the name of the file.
#pragma once

#include <string>
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

// True if the line refuses a setting of one of the overrides "key=value".
bool refuses_override(const std::string& line, const std::vector<std::string>& overrides);

// Returns read(overrides), which reads the text of the file with overrides on top of it. An error in the text
// begins with the name of that file. A refusal of an override does not name the file. A refusal counts as
// that of an override if its line begins with the path of one, or if read() accepts the text without
// overrides.
template <class Read>
auto with_file_in_refusal(const std::string& file, const std::vector<std::string>& overrides, Read&& read) {
  const auto is_refused_alone = [&] {
    try {
      read(std::vector<std::string>());
      return false;
    } catch (const InputError&) {
      return true;
    }
  };
  try {
    return read(overrides);
  } catch (const FileRefusal&) {  // the error is in another file, which this text names
    throw;
  } catch (const InputError& error) {
    const std::string line = without_subject(file, error.what());
    if (overrides.empty() || (!refuses_override(line, overrides) && is_refused_alone()))
      throw FileRefusal(file, line);
    throw InputError(line);
  }
}

}  // namespace remote_touch
