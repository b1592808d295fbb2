// The one exception for bad input: a file, a parameter or a flag that cannot be used. The message is a single
// line "subject: what is wrong, what is expected"; the command line prints it and exits with 2.
#pragma once

#include <stdexcept>
#include <string>

namespace remote_touch {

// One line of UTF-8: a line break becomes a blank, other control characters and bytes that are not UTF-8 are
// written as \x and two hexadecimal digits. Of a word longer than 400 bytes the middle becomes "...".
std::string printable(const std::string& text);

class InputError : public std::runtime_error {
 public:
  // subject: the file or the parameter path, as the user would write it.
  InputError(const std::string& subject, const std::string& problem) : InputError(subject + ": " + problem) {}
  // Both in one, as the validate() functions return them.
  explicit InputError(const std::string& line) : std::runtime_error(printable(line)) {}
};

}  // namespace remote_touch
