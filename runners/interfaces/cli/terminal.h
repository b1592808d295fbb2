// What people read on a terminal: lines that fit into it, and the name that they may have meant.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace remote_touch {

// Returns a line in lines of at most `width` characters, each of which ends with a line feed. It is broken at
// spaces; a word that is longer than a line stays whole. Later lines begin below the last column of a table,
// if that is in the left half, else two spaces further than the first one. Characters are those of UTF-8.
std::string wrapped(std::string_view line, std::size_t width);

// If standard output is a terminal, wraps all lines that are printed by the C library from now on, at the
// width of the terminal, or at 80 characters if it does not tell. Nothing changes for a file or a pipe.
void wrap_standard_output();

// Returns "; did you mean X" if one of the known words is spelt similarly, else an empty text.
std::string suggestion(const std::string& word, const std::vector<std::string>& known);

}  // namespace remote_touch
