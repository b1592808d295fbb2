// Words and numbers of mesh files that are text. They are checked here, because the library that reads these
// files accepts a word that only begins with a number ("0x9" as 0, "9D-1" as 9), and reads numbers that are
// missing in a line from the next line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace remote_touch {

// Returns the words of the text. Blanks, tabs, line ends, form feeds and the characters of `also` separate
// them.
std::vector<std::string_view> words_of(std::string_view text, std::string_view also = {});

// True if the whole word is a decimal number, perhaps with an exponent and a sign; also nan and inf.
bool is_number(std::string_view word);
// Returns the value if the whole word is a decimal integer, perhaps with a sign; else nothing.
std::optional<std::int64_t> integer_of(std::string_view word);

// Throws std::runtime_error "line N: PROBLEM" for the line of the text that contains the byte `at`;
// lines are counted from 1.
[[noreturn]] void refuse_line(std::string_view text, std::size_t at, const std::string& problem);
// Returns the word in quotes, shortened, for a message.
std::string in_quotes(std::string_view word);

}  // namespace remote_touch
