#include "scenarios/recordings/recording.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/geometry/camera.h"
#include "scenarios/recordings/bag_frames.h"
#include "scenarios/recordings/folder_files.h"
#include "scenarios/recordings/frame_layout.h"
#include "scenarios/recordings/images_and_clouds/depth_png.h"
#include "scenarios/recordings/images_and_clouds/pcd_file.h"
#include "scenarios/recordings/tum_layout.h"
#include "scenarios/text_files/file_ending.h"
#include "scenarios/text_files/json_text.h"
#include "scenarios/text_files/refuse.h"
#include "scenarios/text_files/text_file.h"

namespace remote_touch {
namespace {

namespace fs = std::filesystem;

constexpr double kNominalRate_hz = 30;  // rate of the Kinect class; used if a recording has none
constexpr double kNoLimit_m = std::numeric_limits<double>::infinity();

// Content of camera.json about the camera. The rate, which TUM folders do not need, is read separately.
struct CameraFile {
  CameraIntrinsics camera;
  double metres_per_unit = 0;
  bool colour_registered = false;
};

// The defaults of the TUM RGB-D benchmark.
constexpr CameraFile kTumCamera = {{640, 480, 525, 525, 319.5, 239.5}, 1.0 / 5000, true};

// camera.json: an object with these keys only, so that a misspelt one is found.
Json parse_camera_file(const fs::path& file) {
  static const Json kKeys = {"width",         "height",           "fx", "fy", "cx", "cy", "depth_scale_m",
                             "frame_rate_hz", "colour_registered"};
  Json json = parse_json(read_input_text(file, "expected an object of plain values"), file.string());
  if (!json.is_object()) refuse(file, "is of type ", json.type_name(), ": expected object");
  for (const auto& item : json.items()) {
    const std::string& key = item.key();
    const auto is_key = [&key](const Json& name) { return name.get_ref<const std::string&>() == key; };
    if (std::any_of(kKeys.begin(), kKeys.end(), is_key)) continue;
    refuse(file, "key ", shown(key), ": expected ", kKeys.dump());
  }
  return json;
}

// Returns the value of a required key, a finite number. Throws InputError if it is missing or of another
// kind.
double number(const fs::path& file, const Json& json, const std::string& key, bool positive) {
  const auto found = json.find(key);
  if (found == json.end()) refuse(file, "has no key '", key, "'");
  const double value = found->is_number() ? found->get<double>() : std::nan("");
  if (!std::isfinite(value) || (positive && value <= 0))
    refuse(file, key, " = ", shown(*found), ": expected a number", (positive ? " above 0" : ""));
  return value;
}

// Returns a value from 1 to 65535, which is more pixels a side than any depth camera has.
int pixel_count(const fs::path& file, const Json& json, const std::string& key) {
  constexpr double kMaxCount = 65535;
  const double value = number(file, json, key, true);
  if (value == std::floor(value) && value <= kMaxCount) return static_cast<int>(value);
  refuse(file, key, " = ", shown(json[key]), ": expected an integer from 1 to 65535");
}

double frame_rate(const fs::path& file, const Json& json) {
  const double value = number(file, json, "frame_rate_hz", true);
  if (value <= kMaxFrameRate_hz) return value;
  refuse(file, "frame_rate_hz = ", shown(json["frame_rate_hz"]), ": expected above 0 to 10000");
}

// Reads the intrinsics and the scale, which are required, and colour_registered, which is optional.
CameraFile read_camera(const fs::path& file, const Json& json) {
  CameraFile result;
  CameraIntrinsics& camera = result.camera;
  camera.width = pixel_count(file, json, "width"), camera.height = pixel_count(file, json, "height");
  camera.fx = number(file, json, "fx", true), camera.fy = number(file, json, "fy", true);
  camera.cx = number(file, json, "cx", false), camera.cy = number(file, json, "cy", false);
  result.metres_per_unit = number(file, json, "depth_scale_m", true);
  if (const auto found = json.find("colour_registered"); found != json.end()) {
    if (!found->is_boolean()) refuse(file, "colour_registered = ", shown(*found), ": expected true, false");
    result.colour_registered = found->get<bool>();
  }
  return result;
}

// Returns the nominal rate for a recording of one frame, because one stamp states no rate.
double mean_rate_hz(const std::string& file, std::size_t frames, double last_s) {
  if (frames < 2) return kNominalRate_hz;
  const double rate_hz = static_cast<double>(frames - 1) / last_s;
  if (rate_hz > kMaxFrameRate_hz)
    refuse(file, "has timestamps of more than 10000 frames a second: expected seconds");
  return rate_hz;
}

// Lists a TUM folder. camera.json is optional here. A rate in it is not used, because the rate follows from
// the stamps.
RecordingIndex index_tum(const fs::path& folder) {
  const std::vector<StampedFile> depth = read_stamped_list(folder / "depth.txt");
  std::vector<StampedFile> colour;
  CameraFile camera = kTumCamera;
  const fs::path camera_file = folder / "camera.json";
  RecordingIndex index;
  index.texts = {folder / "depth.txt"};
  if (fs::exists(camera_file)) {
    camera = read_camera(camera_file, parse_camera_file(camera_file));
    index.texts.push_back(camera_file);
  }
  if (camera.colour_registered && fs::exists(folder / "rgb.txt")) {
    colour = read_stamped_list(folder / "rgb.txt");
    index.texts.push_back(folder / "rgb.txt");
  }
  index.camera = camera.camera, index.metres_per_unit = camera.metres_per_unit;
  index.frames = associate_stamps(depth, colour);
  index.is_stamped = true;
  const auto has_colour = [](const RecordedFrame& frame) { return !frame.colour.empty(); };
  if (!colour.empty() && std::none_of(index.frames.begin(), index.frames.end(), has_colour))
    refuse(folder / "rgb.txt", "no image is within 0.02 s of one in depth.txt; the first are ",
           colour.front().file.string(), " and ", depth.front().file.string(),
           ": expected stamps of one clock, in seconds");
  index.frame_rate_hz =
      mean_rate_hz((folder / "depth.txt").string(), index.frames.size(), index.frames.back().captured_s);
  return index;
}

// Frame j of a steady rate is captured at j / rate.
void append_frames(RecordingIndex& index, const std::vector<fs::path>& files) {
  for (std::size_t j = 0; j < files.size(); ++j) {
    index.frames.push_back({static_cast<double>(j) / index.frame_rate_hz, files[j], {}});
  }
}

RecordingIndex index_depth_folder(const fs::path& folder) {
  const fs::path camera_file = folder / "camera.json";
  if (!fs::exists(camera_file))
    refuse(camera_file,
           "is missing: depth images need {width, height, fx, fy, cx, cy, depth_scale_m, frame_rate_hz}");
  const Json json = parse_camera_file(camera_file);
  const CameraFile camera = read_camera(camera_file, json);
  RecordingIndex index;
  index.texts = {camera_file};
  index.camera = camera.camera, index.metres_per_unit = camera.metres_per_unit;
  index.frame_rate_hz = frame_rate(camera_file, json);
  const std::vector<fs::path> depth = files_in_order(folder / "depth", ".png");
  if (depth.empty()) refuse(folder / "depth", "holds no .png file");
  append_frames(index, depth);
  if (!camera.colour_registered) return index;
  const std::vector<fs::path> colours = colour_images(depth, folder / "rgb");
  for (std::size_t j = 0; j < depth.size(); ++j) index.frames[j].colour = colours[j];
  return index;
}

RecordingIndex index_of_clouds(RecordingIndex::Kind kind) {
  RecordingIndex index;
  index.kind = kind, index.metres_per_unit = 1, index.frame_rate_hz = kNominalRate_hz;
  return index;
}

// Uses only the rate of camera.json: the intrinsics follow from the points of each PCD file.
RecordingIndex index_pcd(const std::vector<fs::path>& files, const fs::path& camera_file) {
  RecordingIndex index = index_of_clouds(RecordingIndex::Kind::pcd);
  if (fs::exists(camera_file)) {
    index.frame_rate_hz = frame_rate(camera_file, parse_camera_file(camera_file));
    index.texts = {camera_file};
  }
  append_frames(index, files);
  return index;
}

RecordingIndex index_bag(const fs::path& path, const BagChoice& choice) {
  RecordingIndex index = index_of_clouds(RecordingIndex::Kind::bag);
  index.is_stamped = true;
  index.bag = std::make_shared<const BagFrames>(path, choice);
  index.camera = index.bag->camera();
  for (const double captured_s : index.bag->captured_s()) index.frames.push_back({captured_s, {}, {}});
  index.frame_rate_hz = mean_rate_hz(path.string(), index.frames.size(), index.frames.back().captured_s);
  return index;
}

// Returns the same name for "DIR" and "DIR/", and the name of the current folder for ".". The root has no
// name, so its path is returned.
std::string name_of(const fs::path& path) {
  const fs::path clean = fs::absolute(path / "").lexically_normal().parent_path();
  return clean.has_filename() ? clean.filename().string() : clean.string();
}

// Tries the layouts in the order that index_recording() promises.
RecordingIndex index_any(const fs::path& path, const BagChoice& choice) {
  if (fs::exists(path) && is_bag(path)) return index_bag(path, choice);
  for (const auto& [name, value] :
       {std::pair("topic", choice.topic), {"camera_info", choice.camera_info}, {"frame_id", choice.frame_id}})
    if (!value.empty()) refuse(path, "is not a ROS bag: expected scenario.", name, " = \"\"");
  if (choice.depth_unit_m != 0) refuse(path, "is not a ROS bag: expected scenario.depth_unit_m = 0");
  if (choice.images != BagChoice::Images::by_name)
    refuse(path, "is not a ROS bag: expected scenario.images = by-name");
  if (fs::is_regular_file(path) && has_ending(path, ".pcd")) return index_pcd({path}, {});
  if (!fs::is_directory(path))
    refuse(path, fs::exists(path) ? "is of another kind" : "does not exist",
           ": expected a recording folder, a .pcd file or a bag (.mcap, .db3, .bag)");
  if (fs::exists(path / "depth.txt")) return index_tum(path);
  if (fs::is_directory(path / "depth")) return index_depth_folder(path);
  const std::vector<fs::path> clouds = files_in_order(path, ".pcd");
  if (!clouds.empty()) return index_pcd(clouds, path / "camera.json");
  refuse(path,
         "is not a recording: expected a folder that holds depth.txt (TUM), depth/*.png, *.pcd or "
         "metadata.yaml with a ROS 2 bag");
}

// Throws InputError unless the image has the camera's size: pixel (u, v) must be point v * width + u in
// depth, colour and camera.
void check_size(const fs::path& file, int width, int height, const CameraIntrinsics& camera) {
  if (width == camera.width && height == camera.height) return;
  refuse(file, "has ", width, " x ", height, " pixels: expected ", camera.width, " x ", camera.height,
         ", as the camera has");
}

}  // namespace

RecordingIndex index_recording(const fs::path& path, const BagChoice& choice) {
  try {
    RecordingIndex index = index_any(path, choice);
    index.name = name_of(path);
    return index;
  } catch (const fs::filesystem_error& error) {  // a folder that may not be entered
    refuse(error.path1(), "cannot be read: ", error.code().message());
  }
}

std::string description(const RecordingIndex& index, const std::string& rate) {
  const std::string kind = index.bag                                 ? index.bag->kind()
                           : index.kind == RecordingIndex::Kind::pcd ? "PCD"
                                                                     : "depth PNG";
  std::string text =
      index.name + ": " + std::to_string(index.frames.size()) + " frame(s) from " + kind + " at " + rate;
  if (index.camera.width > 0)
    text +=
        ", " + std::to_string(index.camera.width) + " x " + std::to_string(index.camera.height) + " pixels";
  return text;
}

std::string frame_name(const RecordingIndex& index, std::size_t frame) {
  assert(frame < index.frames.size());
  return index.bag ? index.bag->name_of(frame) : index.frames[frame].depth.string();
}

PointCloud read_frame(const RecordingIndex& index, std::size_t frame, double max_depth_m,
                      FrameCamera* camera) {
  assert(frame < index.frames.size());
  if (camera) *camera = {};
  if (index.bag) return index.bag->cloud(frame, max_depth_m);
  const RecordedFrame& source = index.frames[frame];
  if (index.kind == RecordingIndex::Kind::pcd) {
    PcdCloud file = read_pcd(source.depth);
    if (camera) *camera = {file.X_FC, file.has_unused_viewpoint};
    drop_beyond(max_depth_m, file.cloud);
    return std::move(file.cloud);
  }
  const DepthImage depth = read_depth_png(source.depth, index.metres_per_unit, max_depth_m);
  check_size(source.depth, depth.width, depth.height, index.camera);
  PointCloud cloud = cloud_from_depth(depth, index.camera, RigidTransform::Identity());
  if (!source.colour.empty()) {
    int width = 0, height = 0;
    cloud.colour = read_colour_png(source.colour, width, height);
    check_size(source.colour, width, height, index.camera);
  }
  return cloud;
}

}  // namespace remote_touch
