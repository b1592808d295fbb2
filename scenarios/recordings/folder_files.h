// The images or clouds of a folder in order, and which colour image belongs to which depth image.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace remote_touch {

// The files with this extension, in the order of sort_by_name(). Throws InputError about a link to a file
// that is not there.
std::vector<std::filesystem::path> files_in_order(const std::filesystem::path& folder,
                                                  const std::string& extension);

// For each depth image its colour image, or an empty path. Where the folder has a file with the name of any
// depth image, names decide: a depth image whose name is not there has no colour image. Otherwise the numbers
// in the names do: frame-000007.color.png belongs to frame-000007.depth.png. Throws InputError, naming an
// image of each kind, when no image or several have the numbers of another, and about the folder when it
// holds only files of other kinds. Without the folder there are no colour images.
std::vector<std::filesystem::path> colour_images(const std::vector<std::filesystem::path>& depth,
                                                 const std::filesystem::path& folder);

}  // namespace remote_touch
