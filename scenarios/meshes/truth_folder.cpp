#include "scenarios/meshes/truth_folder.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "scenarios/text_files/file_ending.h"
#include "scenarios/text_files/file_order.h"
#include "scenarios/text_files/json_text.h"
#include "scenarios/text_files/refuse.h"
#include "scenarios/text_files/text_file.h"

namespace remote_touch {
namespace {

namespace fs = std::filesystem;

// Returns the files with one of these endings in the order of sort_by_name(). Hidden files are ignored.
std::vector<fs::path> files_with(const std::vector<std::string_view>& endings, const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const fs::path& file = entry.path();
    const auto fits = [&file](std::string_view ending) { return has_ending(file, ending); };
    if (std::any_of(endings.begin(), endings.end(), fits) && !is_hidden(file)) files.push_back(file);
  }
  sort_by_name(files);
  return files;
}

// Throws InputError unless the value is an object with these keys only. where: its place in the file, such as
// "objects[0]: ", or empty.
void require_keys(const fs::path& file, const std::string& where, const Json& value, const Json& keys) {
  if (!value.is_object()) refuse(file, where, "is of type ", value.type_name(), ": expected object");
  for (const auto& item : value.items()) {
    const std::string& key = item.key();
    const auto is_key = [&key](const Json& name) { return name.get_ref<const std::string&>() == key; };
    if (std::none_of(keys.begin(), keys.end(), is_key))
      refuse(file, where, "key ", shown(key), ": expected ", keys.dump());
  }
}

// Returns the value of a required key, a text that is not empty.
std::string text_of(const fs::path& file, const std::string& where, const Json& json, const char* key) {
  const auto found = json.find(key);
  if (found == json.end()) refuse(file, where, "has no key '", key, "'");
  if (!found->is_string() || found->get_ref<const std::string&>().empty())
    refuse(file, where, key, " = ", shown(*found), ": expected a text");
  return found->get<std::string>();
}

// Returns the file inside truth/ that the value of a key names.
fs::path file_of(const fs::path& json_file, const std::string& where, const Json& json, const char* key) {
  const std::string text = text_of(json_file, where, json, key);
  const fs::path name = text;
  const auto is_up = [](const fs::path& part) { return part == ".."; };
  const bool leaves = name.is_absolute() || std::any_of(name.begin(), name.end(), is_up);
  if (leaves || text.find('\0') != text.npos)
    refuse(json_file, where, key, " = ", shown(json[key]), ": expected a file inside truth/");
  fs::path file = json_file.parent_path() / name.lexically_normal();
  if (!fs::is_regular_file(file)) refuse(json_file, where, key, ": no file ", file.string());
  return file;
}

TruthObjectFiles object_of(const fs::path& file, const std::string& where, const Json& json) {
  static const Json kKeys = {"name", "mesh", "poses", "closed"};
  require_keys(file, where, json, kKeys);
  TruthObjectFiles object;
  object.name = text_of(file, where, json, "name");
  object.mesh = file_of(file, where, json, "mesh");
  object.poses = file_of(file, where, json, "poses");
  if (const auto found = json.find("closed"); found != json.end()) {
    if (!found->is_boolean()) refuse(file, where, "closed = ", shown(*found), ": expected true, false");
    object.closed = found->get<bool>();
  }
  return object;
}

TruthFolder described_by(const fs::path& file) {
  static const Json kKeys = {"objects", "uncertainty_m"};
  const Json json = parse_json(read_input_text(file, "expected an object with 'objects'"), file.string());
  require_keys(file, "", json, kKeys);
  const auto list = json.find("objects");
  if (list == json.end()) refuse(file, "has no key 'objects'");
  if (!list->is_array() || list->empty())
    refuse(file, "objects = ", shown(*list), ": expected a list of one object or more");
  TruthFolder truth;
  truth.description = file;
  for (std::size_t i = 0; i < list->size(); ++i)
    truth.objects.push_back(object_of(file, "objects[" + std::to_string(i) + "]: ", (*list)[i]));
  if (const auto found = json.find("uncertainty_m"); found != json.end()) {
    truth.uncertainty_m = found->is_number() ? found->get<double>() : std::nan("");
    if (!(truth.uncertainty_m >= 0 && std::isfinite(truth.uncertainty_m)))
      refuse(file, "uncertainty_m = ", shown(*found), ": expected a number of 0 or more");
  }
  return truth;
}

TruthFolder meshes_in(const fs::path& folder) {
  const fs::path poses = folder / "poses.txt";
  std::vector<fs::path> meshes = files_with({".obj", ".ply", ".stl"}, folder);
  if (meshes.empty() || !fs::is_regular_file(poses))
    refuse(folder, "has neither truth.json nor poses.txt with a mesh: expected one of them");
  const auto is_scene = [](const fs::path& mesh) { return mesh.stem() == "scene"; };
  if (!std::all_of(meshes.begin(), meshes.end(), is_scene)) std::erase_if(meshes, is_scene);
  TruthFolder truth;
  for (const fs::path& mesh : meshes) truth.objects.push_back({mesh.stem().string(), mesh, poses, {}});
  return truth;
}

void require_different_names(const fs::path& subject, const std::vector<TruthObjectFiles>& objects) {
  std::vector<std::string> names;
  for (const TruthObjectFiles& object : objects) names.push_back(object.name);
  std::sort(names.begin(), names.end());
  const auto same = std::adjacent_find(names.begin(), names.end());
  if (same != names.end())
    refuse(subject, "two objects have the name '", *same, "': expected different names");
}

TruthFolder truth_in(const fs::path& folder) {
  const fs::path description = folder / "truth.json";
  const bool is_described = fs::exists(fs::symlink_status(description));
  TruthFolder truth = is_described ? described_by(description) : meshes_in(folder);
  require_different_names(is_described ? description : folder, truth.objects);
  const fs::path masks = folder / "mask";
  if (!fs::exists(fs::symlink_status(masks))) return truth;
  if (!fs::is_directory(masks))
    refuse(masks, "is not a folder: expected the masks of the frames, or nothing");
  truth.masks = masks;
  if (mask_files(truth).empty()) refuse(truth.masks, "has no .png file: expected masks of the frames");
  return truth;
}

}  // namespace

std::optional<TruthFolder> find_truth(const fs::path& recording) {
  try {
    const fs::path folder = recording / "truth";
    if (!fs::is_directory(folder)) return {};
    return truth_in(folder);
  } catch (const fs::filesystem_error& error) {  // a folder that may not be entered
    refuse(error.path1(), "cannot be read: ", error.code().message());
  }
}

std::vector<fs::path> mask_files(const TruthFolder& truth) {
  if (truth.masks.empty()) return {};
  return files_with({".png"}, truth.masks);
}

std::vector<fs::path> files_of(const TruthFolder& truth) {
  std::vector<fs::path> files;
  const auto add = [&files](const fs::path& file) {
    if (!file.empty() && std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
  };
  add(truth.description);
  for (const TruthObjectFiles& object : truth.objects) add(object.mesh), add(object.poses);
  const std::vector<fs::path> masks = mask_files(truth);
  files.insert(files.end(), masks.begin(), masks.end());
  return files;
}

}  // namespace remote_touch
