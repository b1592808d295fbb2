// Converts OBJ files to a text that the library reads correctly.
#pragma once

#include <string>

namespace remote_touch {

// Returns the same shape without parts that a tool does not use and the library may refuse: texture
// coordinates, normals, the files of materials, colours, comments behind the values of a line, and the
// references of faces and lines to these parts. Each line begins with its first word, because the library
// skips lines that are indented. The weight w of `v x y z w` is left out, because only rational curves and
// surfaces have it. Throws std::runtime_error, with the number of the line, for a vertex of 1, 2, 5 or more
// than 7 numbers, for a word that is not a number, and for a corner that is not a vertex.
std::string only_shape(const std::string& obj);

}  // namespace remote_touch
