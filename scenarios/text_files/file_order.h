// The order of the files of a folder.
#pragma once

#include <filesystem>
#include <vector>

namespace remote_touch {

// Sorts files by name. Numbers in names are compared as numbers: frame_9, frame_10, frame_0100. The digits
// after the point of a clock time (nine digits or more) are decimals: 1305031102.16 is before 1305031102.5.
// If the numbers are equal, as 01 and 1, the texts are compared.
void sort_by_name(std::vector<std::filesystem::path>& files);

}  // namespace remote_touch
