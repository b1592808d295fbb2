#include "scenarios/recordings/folder_files.h"

#include <algorithm>
#include <map>
#include <set>

#include "scenarios/text_files/file_ending.h"
#include "scenarios/text_files/file_order.h"
#include "scenarios/text_files/refuse.h"

namespace remote_touch {

namespace fs = std::filesystem;

namespace {

void require_target(const fs::path& file) {
  if (fs::is_symlink(file) && !fs::exists(file))
    refuse(file.string(), "is a link to a file that does not exist: expected a file");
}

std::vector<std::string> numbers_in(const fs::path& file) {
  return numbers_in_name(file.stem().string());
}

[[noreturn]] void refuse_pair(const fs::path& colour, const fs::path& depth) {
  refuse(colour.string(), "it is not clear whether it belongs to ", depth.string(),
         ": expected colour images with the names of the depth images, or with "
         "the same numbers in their names");
}

std::vector<fs::path> paired_by_numbers(const std::vector<fs::path>& depth,
                                        const std::vector<fs::path>& colours) {
  std::map<std::vector<std::string>, fs::path> of_numbers;
  for (const fs::path& colour : colours)
    if (!of_numbers.emplace(numbers_in(colour), colour).second) refuse_pair(colour, depth.front());
  std::vector<fs::path> images(depth.size());
  std::set<std::vector<std::string>> used;
  for (std::size_t j = 0; j < depth.size(); ++j) {
    const auto found = of_numbers.find(numbers_in(depth[j]));
    if (found == of_numbers.end()) continue;
    if (!used.insert(found->first).second) refuse_pair(found->second, depth[j]);
    images[j] = found->second;
  }
  if (used.empty()) refuse_pair(colours.front(), depth.front());
  return images;
}

}  // namespace

std::vector<fs::path> files_in_order(const fs::path& folder, const std::string& extension) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (!has_ending(entry.path(), extension) || is_hidden(entry.path())) continue;
    require_target(entry.path());
    files.push_back(entry.path());
  }
  sort_by_name(files);
  return files;
}

std::vector<fs::path> colour_images(const std::vector<fs::path>& depth, const fs::path& folder) {
  std::vector<fs::path> images(depth.size());
  require_target(folder);
  if (!fs::is_directory(folder)) return images;
  const std::vector<fs::path> colours = files_in_order(folder, ".png");
  if (colours.empty() && !fs::is_empty(folder))
    refuse(folder.string(), "holds no .png file: expected the colour images of ", depth.front().string(),
           " and the others");
  if (colours.empty()) return images;
  std::map<std::string, fs::path> of_stem;
  for (const fs::path& colour : colours) of_stem.emplace(colour.stem().string(), colour);
  bool any = false;
  for (std::size_t j = 0; j < depth.size(); ++j) {
    const fs::path same = folder / depth[j].filename();  // a folder may hold both 1.png and 1.PNG
    const auto found = of_stem.find(depth[j].stem().string());
    if (found == of_stem.end()) continue;
    images[j] = fs::exists(same) ? same : found->second, any = true;
  }
  return any ? images : paired_by_numbers(depth, colours);
}

}  // namespace remote_touch
