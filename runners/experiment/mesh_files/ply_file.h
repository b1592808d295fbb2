// Checks of PLY files, whose data the library that reads them does not compare with the header.
#pragma once

#include <filesystem>
#include <string>

namespace remote_touch {

// Returns the problem of the header in one line, such as counts that the file is too short for; empty if
// there is none.
std::string ply_problem(const std::filesystem::path& file);

// Returns the file with the vertices first, as the library needs them, and without empty lines. The other
// elements keep their order. pre: ply_problem() finds none. Throws std::runtime_error for a format or a type
// that is unknown, for data that end before the last element, and for anything but blanks after it. Each
// element of a text must be a line with all its values and no others, and with integers if the type is an
// integer type; the message then has the number of the line.
std::string with_vertices_first(const std::string& ply);

}  // namespace remote_touch
