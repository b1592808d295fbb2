// The header of a PLY file: whether it ends, and whether the file is long enough for its counts.
#pragma once

#include <filesystem>
#include <string>

namespace remote_touch {

// The problem in one line; empty if there is none.
std::string ply_problem(const std::filesystem::path& file);

// The bytes of a file as the library needs them. Where binary data begin with a line feed it takes that byte
// for the end of the header: one more stands before it then.
std::string with_first_byte_kept(std::string ply);

}  // namespace remote_touch
