// The images or clouds of a folder in order, and the colour image that belongs to each depth image.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace remote_touch {

// Returns the files with this extension (lower case, with its dot; the files may have it in capital letters),
// in the order of sort_by_name(). Hidden files are ignored. Throws InputError about a link to a file that
// does not exist.
std::vector<std::filesystem::path> files_in_order(const std::filesystem::path& folder,
                                                  const std::string& extension);

// Returns the colour image of each depth image, or an empty path. If any colour image has the name of a depth
// image, up to the ending, images are paired by name, and a depth image without a namesake has no colour
// image. Otherwise they are paired by the numbers in their names: frame-000007.color.png belongs to
// frame-000007.depth.png. Throws InputError, which names an image of each kind, if two colour images have the
// same numbers, two depth images have the same partner, or no depth image has a partner. Throws InputError if
// the folder holds only files of other kinds. If there is no folder, there are no colour images.
std::vector<std::filesystem::path> colour_images(const std::vector<std::filesystem::path>& depth,
                                                 const std::filesystem::path& folder);

}  // namespace remote_touch
