// The order of the files of a folder.
#pragma once

#include <filesystem>
#include <vector>

namespace remote_touch {

// By their names, in which numbers are compared as numbers: frame_9, frame_10, frame_0100. Behind the point
// of a time of a clock, which has nine digits or more, come decimals: 1305031102.16 is before 1305031102.5.
// Where numbers are equal, 01 and 1, the texts are compared.
void sort_by_name(std::vector<std::filesystem::path>& files);

}  // namespace remote_touch
