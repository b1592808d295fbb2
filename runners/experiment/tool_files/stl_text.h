// STL files of text as the library that reads them can take them.
#pragma once

#include <string>

namespace remote_touch {

// True if the bytes are an STL file of text: they begin with "solid", in any case, and do not have the length
// that a binary file with their number of facets has.
bool is_stl_text(const std::string& bytes);

// The same triangles, written as the library expects it: keywords in lower case, no names, and normals of 0,
// which a tool does not use. Throws std::runtime_error, with the number of the line, for a facet that has not
// three vertices of three numbers, and for any other word than those of the format, also at the end.
std::string plain_stl(const std::string& text);

}  // namespace remote_touch
