#include "scenarios/meshes/truth_folder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "scenarios/meshes/pose_file.h"
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

// --- the layout of BOP ---

// Returns `count` numbers of a list.
template <std::size_t kCount>
std::array<double, kCount> numbers_of(const fs::path& file, const std::string& where, const Json& json,
                                      const char* key) {
  const auto found = json.find(key);
  const bool is_list = found != json.end() && found->is_array() && found->size() == kCount &&
                       std::all_of(found->begin(), found->end(), [](const Json& x) { return x.is_number(); });
  if (!is_list) refuse(file, where, "expected ", key, ", a list of ", kCount, " numbers");
  std::array<double, kCount> numbers{};
  std::transform(found->begin(), found->end(), numbers.begin(),
                 [](const Json& x) { return x.get<double>(); });
  return numbers;
}

RigidTransform pose_of_bop(const fs::path& file, const std::string& where, const Json& json) {
  const std::array<double, 9> R = numbers_of<9>(file, where, json, "cam_R_m2c");
  const std::array<double, 3> t_mm = numbers_of<3>(file, where, json, "cam_t_m2c");
  std::array<double, 12> rows{};
  for (std::size_t row = 0; row < 3; ++row) {
    std::copy_n(R.begin() + 3 * static_cast<std::ptrdiff_t>(row), 3,
                rows.begin() + 4 * static_cast<std::ptrdiff_t>(row));
    rows[4 * row + 3] = t_mm[row] / 1000;
  }
  const std::optional<RigidTransform> X = pose_of_rows(file.string() + ": " + where, rows);
  if (!X) refuse(file, where, "expected a pose of finite numbers");
  return *X;
}

// Returns the folder of the models of a scene; empty: there is none.
fs::path models_of(const fs::path& scene) {
  fs::path folder = fs::absolute(scene / "").lexically_normal().parent_path();
  for (int level = 0; level < 3; ++level, folder = folder.parent_path())
    if (fs::is_directory(folder / "models")) return folder / "models";
  return {};
}

fs::path model_file(const fs::path& models, int number) {
  char name[32];
  std::snprintf(name, sizeof name, "obj_%06d.ply", number);
  return models / name;
}

std::optional<TruthFolder> truth_of_bop(const fs::path& scene) {
  const fs::path file = scene / "scene_gt.json", models = models_of(scene);
  if (models.empty()) return {};
  const Json json = parse_json(read_input_text(file, "expected the poses of BOP"), file.string());
  if (!json.is_object()) refuse(file, "is of type ", json.type_name(), ": expected object");
  std::map<std::pair<int, int>, TruthObjectFiles> objects;  // key: number, and count in an image
  for (const auto& image : json.items()) {
    std::map<int, int> counts;
    for (const Json& entry : image.value()) {
      const std::string where = "image " + image.key() + ": ";
      const auto number = entry.is_object() ? entry.find("obj_id") : entry.end();
      if (number == entry.end() || !number->is_number_unsigned())
        refuse(file, where, "expected entries with obj_id, a number");
      const int id = number->get<int>(), count = ++counts[id];
      TruthObjectFiles& object = objects[{id, count}];
      object.name = "obj_" + std::to_string(id) + (count > 1 ? "_" + std::to_string(count) : "");
      object.mesh = model_file(models, id), object.poses = file, object.metres_per_unit = 1e-3;
      const std::vector<std::string> frame = numbers_in_name(image.key());
      if (frame.size() != 1) refuse(file, "image ", image.key(), ": expected the number of an image");
      object.X_CO.emplace(frame.front(), pose_of_bop(file, where, entry));
    }
  }
  if (objects.empty()) refuse(file, "has no object: expected the poses of BOP");
  TruthFolder truth;
  truth.name = "scene_gt.json", truth.description = file;
  for (auto& [place, object] : objects) truth.objects.push_back(std::move(object));
  if (fs::is_directory(scene / "mask_visib")) truth.masks = scene / "mask_visib";
  return truth;
}

}  // namespace

std::optional<TruthFolder> find_truth(const fs::path& recording) {
  try {
    const fs::path folder = recording / "truth";
    if (fs::is_directory(folder)) return truth_in(folder);
    return fs::exists(recording / "scene_gt.json") ? truth_of_bop(recording) : std::nullopt;
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
