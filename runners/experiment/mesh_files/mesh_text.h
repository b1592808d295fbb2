// Mesh files that are text: their words are checked, and OBJ and STL are converted to what the library reads
// correctly.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace remote_touch {

// Words and numbers of mesh files that are text are checked here, because the library that reads these files
// accepts a word that only begins with a number ("0x9" as 0, "9D-1" as 9), and reads numbers that are missing
// in a line from the next line.

// Throws std::runtime_error "line N: PROBLEM" for the line of the text that contains the byte `at`;
// lines are counted from 1.
[[noreturn]] void refuse_line(std::string_view text, std::size_t at, const std::string& problem);
// Returns the word in quotes, shortened, for a message.
std::string in_quotes(std::string_view word);

// Converts an OBJ file: returns the same shape without parts that a tool does not use and the library may
// refuse: texture coordinates, normals, the files of materials, colours, comments behind the values of a
// line, and the references of faces and lines to these parts. Each line begins with its first word, because
// the library skips lines that are indented. The weight w of `v x y z w` is left out, because only rational
// curves and surfaces have it. Throws std::runtime_error, with the number of the line, for a vertex of 1, 2,
// 5 or more than 7 numbers, for a word that is not a number, and for a corner that is not a vertex.
std::string only_shape(const std::string& obj);

// True if the bytes are an STL file of text: they begin with "solid", in any case, have no byte 0, and do not
// have the length that a binary file with their number of facets has.
bool is_stl_text(const std::string& bytes);

// Returns the same triangles, written as the library expects them: keywords in lower case, no names, and
// normals of 0, because a tool does not use normals. Throws std::runtime_error, with the number of the line,
// for a facet without exactly three vertices of three numbers, and for any word that the format does not
// have, also at the end.
std::string plain_stl(const std::string& text);

}  // namespace remote_touch
