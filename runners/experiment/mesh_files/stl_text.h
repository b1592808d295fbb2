// Converts STL files of text to a form that the library reads correctly.
#pragma once

#include <string>

namespace remote_touch {

// True if the bytes are an STL file of text: they begin with "solid", in any case, have no byte 0, and do not
// have the length that a binary file with their number of facets has.
bool is_stl_text(const std::string& bytes);

// Returns the same triangles, written as the library expects them: keywords in lower case, no names, and
// normals of 0, because a tool does not use normals. Throws std::runtime_error, with the number of the line,
// for a facet without exactly three vertices of three numbers, and for any word that the format does not
// have, also at the end.
std::string plain_stl(const std::string& text);

}  // namespace remote_touch
