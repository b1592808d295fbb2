// The images or clouds of a folder in order, and which colour image belongs to which depth image.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace remote_touch {

// The files with this extension (lower case, with its dot), in small or capital letters, in the order of
// sort_by_name(). Hidden files are ignored. Throws InputError about a link to a file that is not there.
std::vector<std::filesystem::path> files_in_order(const std::filesystem::path& folder,
                                                  const std::string& extension);

// Returns the colour image of each depth image, or an empty path. If any colour image has the name of a depth
// image, up to the ending, images are paired by name, and a depth image without a namesake has no colour
// image. Otherwise they are paired by the numbers in their names: frame-000007.color.png belongs to
// frame-000007.depth.png. Throws InputError, which names an image of each kind, when the numbers do not give
// exactly one partner, and when the folder holds only files of other kinds. If there is no folder, there are
// no colour images.
std::vector<std::filesystem::path> colour_images(const std::vector<std::filesystem::path>& depth,
                                                 const std::filesystem::path& folder);

}  // namespace remote_touch
