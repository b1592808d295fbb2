#include "scenarios/objects/recorded_truth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <utility>

#include "core/points/point_cloud.h"
#include "scenarios/files/depth_images.h"
#include "scenarios/files/input_files.h"
#include "scenarios/objects/mesh_object.h"

namespace remote_touch {

namespace fs = std::filesystem;

namespace {

// Returns the files with one of these endings in the order of sort_by_name(). Hidden files are ignored.
std::vector<fs::path> files_with(const std::vector<std::string_view>& endings, const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const fs::path& file = entry.path();
    const auto fits = [&file](std::string_view ending) { return has_ending(file, ending); };
    if (std::ranges::any_of(endings, fits) && !is_hidden(file)) files.push_back(file);
  }
  sort_by_name(files);
  return files;
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
  const bool leaves = name.is_absolute() || std::ranges::any_of(name, is_up);
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
  if (!std::ranges::all_of(meshes, is_scene)) std::erase_if(meshes, is_scene);
  TruthFolder truth;
  for (const fs::path& mesh : meshes) truth.objects.push_back({mesh.stem().string(), mesh, poses, {}});
  return truth;
}

void require_different_names(const fs::path& subject, const std::vector<TruthObjectFiles>& objects) {
  std::vector<std::string> names;
  for (const TruthObjectFiles& object : objects) names.push_back(object.name);
  std::ranges::sort(names);
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

std::optional<TruthFolder> truth_of_bop(const fs::path& scene) {
  const fs::path file = scene / "scene_gt.json", models = models_of(scene);
  if (models.empty()) return {};
  const Json json = parse_json(read_input_text(file, "expected the poses of BOP"), file.string());
  require_object(file, "", json);
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
      object.mesh = models / formatted("obj_%06d.ply", id), object.poses = file,
      object.metres_per_unit = 1e-3;
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

constexpr std::size_t kMaxCached = 8;  // the number that RecordedScene keeps frames

// Returns the masks of each frame.
std::vector<std::vector<fs::path>> masks_of_frames(const TruthFolder& truth,
                                                   const std::vector<std::string>& frames) {
  const std::map<std::vector<std::string>, std::size_t> frame_of = frames_by_numbers(truth.masks, frames);
  std::vector<std::vector<fs::path>> of_frames(frames.size());
  std::set<std::size_t> whole;  // frames with a mask of the whole image
  for (const fs::path& mask : mask_files(truth)) {
    std::vector<std::string> numbers = numbers_in_name(mask.stem().string());
    auto frame = frame_of.find(numbers);
    const bool is_whole = frame != frame_of.end();
    if (!is_whole && !numbers.empty()) {
      numbers.pop_back();
      frame = frame_of.find(numbers);
    }
    if (frame == frame_of.end())
      refuse(mask,
             "its name has the number of no frame: expected names with the numbers of the depth images, such "
             "as those of ",
             frames.front(), ", and perhaps the number of an object");
    std::vector<fs::path>& masks = of_frames[frame->second];
    if (is_whole ? !masks.empty() : whole.contains(frame->second))
      refuse(mask, "frame ", frame->second, " has another mask, ", masks.front().string(), ": expected one");
    if (is_whole) whole.insert(frame->second);
    masks.push_back(mask);
  }
  return of_frames;
}

using Poses = std::vector<std::optional<RigidTransform>>;

constexpr std::size_t kSamples = 400;  // number of points on each object

MeshObject object_of(const TruthObjectFiles& files, const MeshReader& read_mesh) {
  TriangleMesh mesh = read_mesh(files.mesh);
  if (files.metres_per_unit != 1)
    for (Vec3& vertex : mesh.vertices) vertex *= files.metres_per_unit;
  return checked_object(files.name, mesh, files.closed,
                        {files.mesh.string(), ", or \"closed\": false in truth.json"});
}

Poses poses_by_number(const TruthObjectFiles& object, const std::vector<std::string>& frames) {
  Poses poses(frames.size());
  for (const auto& [numbers, frame] : frames_by_numbers(object.poses, frames))
    if (const auto found = object.X_CO.find(numbers.back()); found != object.X_CO.end())
      poses[frame] = found->second;
  return poses;
}

Poses poses_in_file(const std::filesystem::path& file, std::size_t frame_count) {
  Poses poses = read_poses(file, PoseLines::of_frames).poses;
  if (poses.size() != frame_count)
    refuse(file, poses.size(), " poses for ", frame_count, " frames: expected one line for each frame");
  return poses;
}

// Returns the poses of all objects, those of one frame side by side.
Poses poses_of(const TruthFolder& folder, const std::vector<std::string>& frames) {
  const std::size_t count = folder.objects.size();
  Poses poses(frames.size() * count);
  for (std::size_t i = 0; i < count; ++i) {
    const TruthObjectFiles& object = folder.objects[i];
    const Poses of_object =
        object.X_CO.empty() ? poses_in_file(object.poses, frames.size()) : poses_by_number(object, frames);
    for (std::size_t frame = 0; frame < frames.size(); ++frame) poses[frame * count + i] = of_object[frame];
  }
  return poses;
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
    if (!file.empty() && std::ranges::find(files, file) == files.end()) files.push_back(file);
  };
  add(truth.description);
  for (const TruthObjectFiles& object : truth.objects) add(object.mesh), add(object.poses);
  const std::vector<fs::path> masks = mask_files(truth);
  files.insert(files.end(), masks.begin(), masks.end());
  return files;
}

TruthMasks::TruthMasks(const TruthFolder& truth, const std::vector<std::string>& frames,
                       const CameraIntrinsics& camera)
    : camera_(camera) {
  if (truth.masks.empty()) return;
  if (camera.pixels() == 0) refuse(truth.masks, "the frames are not images: expected no masks");
  files_ = masks_of_frames(truth, frames);
}

bool TruthMasks::holds_at(std::size_t frame, const Vec3& p_C) const {
  if (files_.empty()) return true;
  const std::optional<std::size_t> pixel = pixel_of(camera_, p_C);
  return pixel && !files_[frame].empty() && mask_of(frame)[*pixel];
}

const std::vector<bool>& TruthMasks::mask_of(std::size_t frame) const {
  const auto found = std::ranges::find_if(cache_, [&](const Mask& mask) { return mask.frame == frame; });
  if (found != cache_.end()) {
    std::rotate(cache_.begin(), found, found + 1);
  } else {
    std::vector<bool> mask = read(frame);
    if (cache_.size() == kMaxCached) cache_.pop_back();
    cache_.insert(cache_.begin(), {frame, std::move(mask)});
  }
  return cache_.front().holds;
}

std::vector<bool> TruthMasks::read(std::size_t frame) const {
  std::vector<bool> holds(camera_.pixels(), false);
  for (const fs::path& file : files_[frame]) {
    int width = 0, height = 0;
    const std::vector<std::uint32_t> colours = read_colour_png(file, width, height);
    if (width != camera_.width || height != camera_.height)
      refuse(file, "has ", width, " x ", height, " pixels: expected ", size_text(camera_),
             ", as the camera has");
    for (std::size_t i = 0; i < colours.size(); ++i)
      if (colours[i] != kNoColour && (colours[i] & 0xFFFFFF) != 0) holds[i] = true;
  }
  return holds;
}

RecordedTruth::RecordedTruth(const TruthFolder& folder, const std::vector<std::string>& frames,
                             double reach_m, const MeshReader& read_mesh, const CameraIntrinsics& camera)
    : poses_file_(folder.objects.front().poses),
      X_CO_(poses_of(folder, frames)),
      masks_(folder, frames, camera),
      reach_m_(reach_m),
      uncertainty_m_(folder.uncertainty_m) {
  for (const TruthObjectFiles& files : folder.objects) {
    objects_.push_back(object_of(files, read_mesh));
    samples_.push_back(surface_samples(*objects_.back().shape, kSamples));
    name_ += (name_.empty() ? folder.name + " (" : ", ") + files.name;
  }
  name_ += ")";
  if (std::ranges::none_of(X_CO_, [](const auto& X) { return X.has_value(); }))
    refuse(poses_file_, "has no known pose: expected the pose of an object in a frame or more");
}

void RecordedTruth::require_view(const CameraIntrinsics& camera, const std::string& cause) const {
  if (camera.pixels() == 0) return;
  std::size_t first = X_CO_.size();  // the first known pose
  for (std::size_t i = X_CO_.size(); i-- > 0;) {
    if (!X_CO_[i]) continue;
    if (count_in_image(samples_[i % objects_.size()], *X_CO_[i], camera) > 0) return;
    first = i;
  }
  const Vec3& p_C = X_CO_[first]->translation();
  refuse(poses_file_, "no object is in the image of any frame: ", objects_[first % objects_.size()].name,
         formatted(" is at x %.3g, y %.3g, z %.3g m in frame %zu", p_C.x(), p_C.y(), p_C.z(),
                   first / objects_.size()),
         cause, ": expected object frame to camera frame, x right, y down, z forward, metres");
}

NearestOnObjects RecordedTruth::at(std::size_t frame, const Vec3& p_C) const {
  if (!p_C.allFinite() || !masks_.holds_at(frame, p_C)) return {};
  return nearest_on_objects(objects_, poses(frame), p_C, reach_m_);
}

}  // namespace remote_touch
