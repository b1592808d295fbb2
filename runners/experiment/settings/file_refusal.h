// Refusals of the text of a file, such as that of an experiment. Their line begins with the file.
#pragma once

#include <string>
#include <vector>

#include "core/parameters/input_error.h"

namespace remote_touch {

// A refusal that begins with the file whose text is wrong.
class FileRefusal : public InputError {
 public:
  using InputError::InputError;
};

// Returns the line of a refusal without the subject at its beginning; the line as it is if it has another.
std::string without_subject(const std::string& subject, const std::string& line);

// True if the line refuses a setting of one of the overrides "key=value".
bool is_of_override(const std::string& line, const std::vector<std::string>& overrides);

// Returns read(overrides), which reads the text of the file with overrides on top of it. If it throws
// InputError, the refusal begins with the file. It does not if an override is wrong: the refused setting is
// that of an override, or the text alone is not refused.
template <class Read>
auto read_text_of(const std::string& file, const std::vector<std::string>& overrides, Read&& read) {
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
  } catch (const FileRefusal&) {  // the text names another file, which is wrong
    throw;
  } catch (const InputError& error) {
    const std::string line = without_subject(file, error.what());
    if (overrides.empty() || (!is_of_override(line, overrides) && is_refused_alone()))
      throw FileRefusal(file, line);
    throw InputError(line);
  }
}

}  // namespace remote_touch
