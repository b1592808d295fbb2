// OBJ files as the library that reads them can take them.
#pragma once

#include <string>

namespace remote_touch {

// The same shape without what a tool does not use and the library may refuse: texture coordinates, normals,
// materials and colours, and what faces and lines say of them. Lines begin at their first word: the library
// passes over those that are indented. Throws std::runtime_error for a vertex of fewer than three
// coordinates.
std::string only_shape(const std::string& obj);

}  // namespace remote_touch
