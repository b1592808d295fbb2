// OBJ files as the library that reads them can take them.
#pragma once

#include <string>

namespace remote_touch {

// The same shape without what a tool does not use and the library may refuse: texture coordinates, normals,
// materials, colours and comments, and what faces and lines say of them. Lines begin at their first word: the
// library passes over those that are indented. The weight w of `v x y z w` is left out, because only rational
// curves and surfaces have it. Throws std::runtime_error, with the number of the line, for a vertex of 1, 2,
// 5 or more than 7 numbers, for a word that is not a number, and for a corner that is not a vertex.
std::string only_shape(const std::string& obj);

}  // namespace remote_touch
