// Words and numbers of mesh files that are text. The library that reads them takes the beginning of a word
// for a number ("0x9" for 0, "9D-1" for 9) and goes on in the next line for what is missing in this one.
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
