#include "scenarios/recordings/recording.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "core/points/point_cloud.h"
#include "scenarios/files/depth_images.h"
#include "scenarios/files/input_files.h"
#include "scenarios/objects/recorded_truth.h"
#include "scenarios/recordings/bag_file.h"
#include "scenarios/recordings/camera_path.h"

namespace remote_touch {

namespace fs = std::filesystem;

namespace {

std::string data_folder;

// The largest sizes of files that are read whole. Without a limit here the digest of a larger file is
// computed first, which can take minutes.
void require_readable_size(const fs::path& file) {
  constexpr std::uintmax_t kMaxMeshBytes = std::uintmax_t{2} << 30;  // 5 million triangles as text
  std::error_code unreachable;
  const std::uintmax_t size = fs::file_size(file, unreachable);
  if (unreachable) return;  // the reader refuses it
  for (const char* ending : {".obj", ".ply", ".stl"})
    if (has_ending(file, ending) && size > kMaxMeshBytes)
      refuse(file.string(), "is larger than 2 GiB: expected a mesh of at most 5 million triangles");
  for (const char* ending : {".csv", ".traj", ".txt", ".tum"})
    if (has_ending(file, ending) && size > kMaxTextBytes)
      refuse(file.string(), "is longer than ", kMaxTextBytes >> 20, " MiB: expected a shorter text");
}

// True for images, meshes, paths of poses, measured contacts and live sessions. A recording of frames is not
// made from such files.
bool is_single_file(const fs::path& file) {
  constexpr std::array kEndings = {".png", ".obj", ".ply",  ".stl", ".h5",
                                   ".oni", ".csv", ".traj", ".txt", ".tum"};
  return std::ranges::any_of(kEndings, [&](const char* ending) { return has_ending(file, ending); });
}

// Returns all files of a bag, regardless of the topic and the frames.
std::vector<InputFile> bag_files(const fs::path& bag) {
  std::vector<InputFile> list;
  for (const fs::path& file : files_of_bag(bag)) list.push_back({file.filename().generic_string(), file});
  std::ranges::sort(list, [](const InputFile& a, const InputFile& b) { return a.name < b.name; });
  return list;
}

std::vector<InputFile> listed_files(const InputPart& part) {
  const fs::path found = find_input(part.path);
  if (is_single_file(found)) return {{found.filename().generic_string(), found}};
  if (is_bag(found)) return bag_files(found);
  const RecordingIndex recording = index_recording(found);
  const FrameRange frames = frames_of(part, recording);
  // The folder is absolute, because a list may name files by absolute paths: their names become ../../...
  const fs::path place = fs::absolute(found);
  const fs::path folder = fs::is_directory(place) ? place : place.parent_path();
  std::map<std::string, fs::path> files;
  const auto add = [&](const fs::path& file) {
    files.emplace(fs::absolute(file).lexically_relative(folder).generic_string(), file);
  };
  for (const fs::path& text : recording.texts) add(text);
  for (int i = frames.first; i <= frames.last; ++i) {
    const RecordedFrame& frame = recording.frames[static_cast<std::size_t>(i)];
    add(frame.depth);
    if (!frame.colour.empty()) add(frame.colour);
  }
  if (const fs::path poses = (folder / part.camera_poses).lexically_normal(); !part.camera_poses.empty()) {
    if (!fs::is_directory(poses)) add(poses);
    for (const fs::path& file :
         fs::is_directory(poses) ? pose_files(poses, recording) : std::vector<fs::path>())
      if (!file.empty()) add(file);
  }
  if (const std::optional<TruthFolder> truth = part.with_truth ? find_truth(folder) : std::nullopt)
    for (const fs::path& file : files_of(*truth)) add(file);
  std::vector<InputFile> list;
  for (const auto& [name, file] : files) list.push_back({name, file});
  return list;
}

int rows_of(const PointCloud& cloud) {
  return cloud.columns() == 0 ? 0 : static_cast<int>(cloud.size()) / cloud.columns();
}

std::string size_text(int columns, int rows) {
  return std::to_string(columns) + " x " + std::to_string(rows) + " points";
}

PointCloud image_of_holes(const CameraIntrinsics& camera) {
  PointCloud cloud;
  const auto pixels = camera.pixels();
  cloud.x.assign(pixels, std::nan("")), cloud.y = cloud.x, cloud.z = cloud.x;
  cloud.grid_columns = camera.width;
  return cloud;
}

void conform_to_camera(const CameraIntrinsics& camera, const std::string& subject, PointCloud& cloud) {
  if (cloud.size() == 0) cloud = image_of_holes(camera);
  if (cloud.columns() != camera.width || rows_of(cloud) != camera.height)
    refuse(subject, "has ", size_text(cloud.columns(), rows_of(cloud)), ": expected ",
           size_text(camera.width, camera.height), ", as the first frame that is used has");
  // A depth image has the recording's camera. It is not tested, because a lens may bend its rays by more than
  // a pixel.
  if (cloud.image && cloud.image->camera == camera) return;
  const double residual = largest_error_px(cloud, RigidTransform::Identity(), camera);
  if (!(residual < (cloud.image ? 2 * kMaxFitResidual_px : kMaxFitResidual_px)))
    refuse(subject,
           "has another camera than the first frame that is used, or none: expected points at the "
           "pixels of the same camera");
  if (!cloud.image)
    cloud.image = ImageLayout{camera, RigidTransform::Identity(), residual + kPixelRounding_px};
}

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

void set_data_folder(const std::string& folder) {
  data_folder = folder;
}

std::string input_places() {
  return "here or below REMOTE_TOUCH_DATA" + (data_folder.empty() ? " (not set)" : " = " + data_folder);
}

std::string find_input(const std::string& path) {
  const fs::path below = fs::path(data_folder) / path;
  const bool may_be_below = !data_folder.empty() && fs::path(path).is_relative();
  for (const fs::path& found : {fs::path(path), may_be_below ? below : fs::path()}) {
    std::error_code unreachable;
    if (found.empty() || !fs::exists(found, unreachable)) continue;
    require_file_or_folder(found);
    return found.string();
  }
  throw MissingInput(path, "no such recording, image or mesh: expected a folder or file " + input_places());
}

FrameRange frames_of(const InputPart& part, const RecordingIndex& recording) {
  const int available = static_cast<int>(recording.frames.size());
  const int last = part.last_frame < 0 ? available - 1 : part.last_frame;
  if (part.first_frame >= available || last >= available)
    refuse(part.path, "first_frame = ", part.first_frame, ", last_frame = ", part.last_frame,
           ": expected 0 to ", available - 1);
  return {part.first_frame, last};
}

std::vector<InputFile> files_of(const InputPart& part) {
  std::vector<InputFile> files = listed_files(part);
  for (const InputFile& input : files) require_file(input.file), require_readable_size(input.file);
  return files;
}

double largest_error_px(const PointCloud& cloud, const RigidTransform& X_CW, const CameraIntrinsics& camera) {
  double largest = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_measured(i)) continue;
    const Vec3 p_C = X_CW * cloud.point(i);
    if (!(p_C.z() > 0)) return std::numeric_limits<double>::infinity();
    const int place = static_cast<int>(i), u = place % camera.width, v = place / camera.width;
    largest = std::max({largest, std::abs(camera.fx * p_C.x() / p_C.z() + camera.cx - u),
                        std::abs(camera.fy * p_C.y() / p_C.z() + camera.cy - v)});
  }
  return largest;
}

FrameLayout layout_of(const PointCloud& cloud) {
  FrameLayout layout{cloud.columns() > 0, {}};
  if (cloud.image) layout.camera = cloud.image->camera;
  return layout;
}

void conform(const FrameLayout& layout, const std::string& subject, PointCloud& cloud) {
  if (cloud.size() > 0 && layout.is_organised != (cloud.columns() > 0))
    refuse(subject, layout.is_organised
                        ? "has points in no order: expected an organised cloud, as the first frame "
                          "that is used is"
                        : "is an organised cloud: expected points in no order, as the first frame "
                          "that is used has");
  if (layout.camera)
    conform_to_camera(*layout.camera, subject, cloud);
  else
    cloud.image.reset();
}

void drop_beyond(double max_depth_m, PointCloud& cloud) {
  for (std::size_t i = 0; cloud.image && i < cloud.size(); ++i) {
    if (!(cloud.z[i] > max_depth_m)) continue;
    cloud.x[i] = cloud.y[i] = cloud.z[i] = std::numeric_limits<double>::quiet_NaN();
  }
}

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
  return text + ", " + size_text(camera) +
         formatted(", f = %.6g, %.6g, c = %.6g, %.6g (", camera.fx, camera.fy, camera.cx, camera.cy) +
         index.camera_source + ")";
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
