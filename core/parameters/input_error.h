// The one exception for bad input: a file, a parameter or a flag that cannot be used. The message is a single
// line "subject: what is wrong, what is expected"; the command line prints it and exits with 2.
#pragma once

#include <stdexcept>
#include <string>

namespace remote_touch {

// Returns the text as one line of UTF-8. A line break or tab becomes a blank. The bytes of other control
// characters (ASCII and U+0080 to U+009F), of the separators U+2028 and U+2029, and those that are not UTF-8
// are written as \x and two hexadecimal digits. The middle of a word longer than 400 bytes, and then of a
// line longer than 1000 bytes, is replaced with "...".
std::string printable(const std::string& text);

class InputError : public std::runtime_error {
 public:
  // subject: the file or the parameter path, as the user would write it.
  InputError(const std::string& subject, const std::string& problem) : InputError(subject + ": " + problem) {}
  // line: subject and problem in one line, as the validate() functions return them.
  explicit InputError(const std::string& line) : std::runtime_error(printable(line)) {}
};

}  // namespace remote_touch
