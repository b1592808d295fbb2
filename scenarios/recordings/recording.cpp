#include "scenarios/recordings/recording.h"

#include <cassert>
#include <cstdio>
#include <limits>
#include <optional>
#include <utility>

#include "core/geometry/camera.h"
#include "scenarios/recordings/bag_frames.h"
#include "scenarios/recordings/camera_file.h"
#include "scenarios/recordings/folder_files.h"
#include "scenarios/recordings/frame_layout.h"
#include "scenarios/recordings/image_folders.h"
#include "scenarios/recordings/images_and_clouds/depth_npy.h"
#include "scenarios/recordings/images_and_clouds/depth_png.h"
#include "scenarios/recordings/images_and_clouds/pcd_file.h"
#include "scenarios/text_files/file_ending.h"
#include "scenarios/text_files/refuse.h"

namespace remote_touch {
namespace {

namespace fs = std::filesystem;

RecordingIndex index_of_clouds(RecordingIndex::Kind kind) {
  RecordingIndex index;
  index.kind = kind, index.metres_per_unit = 1, index.frame_rate_hz = kNominalRate_hz;
  index.camera_source = "fitted to the points";
  return index;
}

// Uses only the rate of camera.json: the intrinsics follow from the points of each PCD file.
RecordingIndex index_pcd(const std::vector<fs::path>& files, const fs::path& camera_file) {
  RecordingIndex index = index_of_clouds(RecordingIndex::Kind::pcd);
  if (fs::exists(camera_file)) {
    index.frame_rate_hz = read_frame_rate(camera_file);
    index.texts = {camera_file};
  }
  append_frames(files, index);
  return index;
}

RecordingIndex index_bag(const fs::path& path, const BagChoice& choice) {
  RecordingIndex index = index_of_clouds(RecordingIndex::Kind::bag);
  index.is_stamped = true;
  index.bag = std::make_shared<const BagFrames>(path, choice);
  index.first_stamp_s = index.bag->first_stamp_s();
  index.camera = index.bag->camera();
  if (index.camera.width > 0) index.camera_source = "CameraInfo";
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
  if (std::optional<RecordingIndex> images = index_image_folder(path)) return *std::move(images);
  const std::vector<fs::path> clouds = files_in_order(path, ".pcd");
  if (!clouds.empty()) return index_pcd(clouds, path / "camera.json");
  refuse(path,
         "is not a recording: expected a folder that holds depth.txt (TUM), depth/*.png or depth/*.npy, "
         "*.depth.png (7-Scenes), *.pcd or metadata.yaml with a ROS 2 bag");
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
  const std::string kind = index.bag                                        ? index.bag->kind()
                           : index.kind == RecordingIndex::Kind::pcd        ? "PCD"
                           : has_ending(index.frames.front().depth, ".npy") ? "depth NumPy"
                                                                            : "depth PNG";
  std::string text =
      index.name + ": " + std::to_string(index.frames.size()) + " frame(s) from " + kind + " at " + rate;
  const CameraIntrinsics& camera = index.camera;
  if (camera.width == 0) return text;
  char intrinsics[96];
  std::snprintf(intrinsics, sizeof intrinsics, ", f = %.6g, %.6g, c = %.6g, %.6g (", camera.fx, camera.fy,
                camera.cx, camera.cy);
  return text + ", " + size_text(camera) + intrinsics + index.camera_source + ")";
}

std::string frame_name(const RecordingIndex& index, std::size_t frame) {
  assert(frame < index.frames.size());
  return index.bag ? index.bag->name_of(frame) : index.frames[frame].depth.string();
}

std::vector<std::string> frame_names(const RecordingIndex& index) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < index.frames.size(); ++i)
    names.push_back(index.bag ? std::to_string(i) : index.frames[i].depth.filename().string());
  return names;
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
  DepthImage depth = read_depth_image(source.depth, index.metres_per_unit);
  check_size(source.depth, depth.width, depth.height, index.camera);
  if (index.depth_along_ray) distances_to_depths(index.camera, depth);
  for (double& z_m : depth.z_m)
    if (!(z_m <= max_depth_m)) z_m = std::numeric_limits<double>::quiet_NaN();
  PointCloud cloud = cloud_from_depth(depth, index.camera, RigidTransform::Identity());
  if (!source.colour.empty()) {
    int width = 0, height = 0;
    cloud.colour = read_colour_png(source.colour, width, height);
    check_size(source.colour, width, height, index.camera);
  }
  return cloud;
}

}  // namespace remote_touch
