#include "scenarios/recordings/recording.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "scenarios/files/depth_images.h"
#include "scenarios/files/input_files.h"

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

Json parse_camera_file(const fs::path& file) {
  static const Json kKeys = {
      "width",      "height", "fx", "fy", "cx", "cy", "depth_scale_m", "frame_rate_hz", "colour_registered",
      "depth_along"};
  Json json = parse_json(read_input_text(file, "expected an object of plain values"), file.string());
  require_keys(file, "", json, kKeys);
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

constexpr double kMaxStamp_s = 1e12;  // some 30000 years; differences of stamps are then exact to 0.1 ms

// Returns seconds since an arbitrary origin. Throws InputError about `where`, the list with ":line", unless
// the whole text is a finite number of at most kMaxStamp_s.
double read_stamp(const std::string& where, const std::string& stamp) {
  double stamp_s = 0;
  const auto [end, error] = std::from_chars(stamp.data(), stamp.data() + stamp.size(), stamp_s);
  if (error == std::errc() && end == stamp.data() + stamp.size() && std::abs(stamp_s) <= kMaxStamp_s)
    return stamp_s;
  refuse(where, "timestamp '", stamp.substr(0, 32), "': expected a number of seconds");
}

constexpr double kMillimetre_m = 1e-3;

void set_camera(const ImageCamera& camera, const fs::path& file, RecordingIndex& index) {
  index.camera = camera.camera, index.metres_per_unit = camera.metres_per_unit;
  index.depth_along_ray = camera.depth_along_ray;
  index.camera_source = camera.source;
  index.frame_rate_hz = camera.frame_rate_hz > 0 ? camera.frame_rate_hz : kNominalRate_hz;
  if (!file.empty()) index.texts.push_back(file);
}

void note_unused_colours(const std::string& colours, const std::string& reason, RecordingIndex& index) {
  index.notes.push_back({"colours missing", "the colours in " + colours + " are not used: " + reason});
}

constexpr const char* kNotRegistered =
    "camera.json does not state \"colour_registered\": true, that a pixel of both images shows the same point";

// --- TUM ---

// The cameras of the colour images of the benchmark, to which its depth images are registered.
ImageCamera tum_camera(const fs::path& folder, const std::string& list, RecordingIndex& index) {
  static const std::array<std::pair<const char*, CameraIntrinsics>, 3> kCameras = {
      {{"freiburg1", {640, 480, 517.3, 516.5, 318.6, 255.3}},
       {"freiburg2", {640, 480, 520.9, 521.0, 325.1, 249.7}},
       {"freiburg3", {640, 480, 535.4, 539.2, 320.1, 247.6}}}};
  ImageCamera result{{640, 480, 525, 525, 319.5, 239.5}, 1.0 / 5000, true, "default of TUM"};
  std::string words = fs::absolute(folder / "").lexically_normal().parent_path().filename().string();
  for_each_line(list, [&](std::size_t, std::string_view line) {
    if (line.starts_with('#')) words.append(line);
  });
  for (const auto& [name, camera] : kCameras)
    if (words.find(name) != words.npos) {
      result.camera = camera, result.source = std::string(name) + " of TUM, distortion ignored";
      return result;
    }
  index.notes.push_back(
      {"camera assumed",
       "there is no camera.json, and neither the folder's name nor a comment in depth.txt names "
       "freiburg1, freiburg2 or freiburg3: the default camera of TUM is used, f = 525"});
  return result;
}

RecordingIndex index_tum(const fs::path& folder) {
  const fs::path list = folder / "depth.txt", colour_list = folder / "rgb.txt";
  const fs::path camera_file = folder / "camera.json";
  const std::vector<StampedFile> depth = read_stamped_list(list);
  RecordingIndex index;
  index.texts = {list};
  const bool has_camera = fs::exists(camera_file), has_colours = fs::exists(colour_list);
  const ImageCamera camera = has_camera ? read_camera_file(camera_file)
                                        : tum_camera(folder, read_input_text(list, "expected a list"), index);
  set_camera(camera, has_camera ? camera_file : fs::path(), index);
  std::vector<StampedFile> colour;
  if (has_colours && !camera.colour_registered) note_unused_colours("rgb.txt", kNotRegistered, index);
  if (has_colours && camera.colour_registered) {
    colour = read_stamped_list(colour_list);
    index.texts.push_back(colour_list);
  }
  index.frames = associate_stamps(depth, colour);
  index.is_stamped = true, index.first_stamp_s = depth.front().stamp_s;
  const auto has_colour = [](const RecordedFrame& frame) { return !frame.colour.empty(); };
  if (!colour.empty() && std::ranges::none_of(index.frames, has_colour))
    refuse(colour_list, "no image is within 0.02 s of one in depth.txt; the first are ",
           colour.front().file.string(), " and ", depth.front().file.string(),
           ": expected stamps of one clock, in seconds");
  index.frame_rate_hz = mean_rate_hz(list.string(), index.frames.size(), index.frames.back().captured_s);
  return index;
}

// --- layouts without stamps ---

// Returns a camera of the size of the first image.
ImageCamera camera_of_images(const std::vector<fs::path>& depth, const CameraIntrinsics& intrinsics,
                             double metres_per_unit, const std::string& source) {
  ImageCamera result{intrinsics, metres_per_unit, false, source};
  const DepthImage first = read_depth_image(depth.front(), metres_per_unit);
  result.camera.width = first.width, result.camera.height = first.height;
  return result;
}

// Returns the camera of all images of a scene of BOP.
ImageCamera bop_camera(const fs::path& file, const std::vector<fs::path>& depth) {
  const Json json = parse_json(read_input_text(file, "expected the cameras of BOP"), file.string());
  require_object(file, "", json);
  std::map<std::string, const Json*> of_number;
  for (const auto& item : json.items())
    for (const std::string& number : numbers_in_name(item.key())) of_number[number] = &item.value();
  std::vector<std::string> names;
  for (const fs::path& image : depth) names.push_back(image.filename().string());
  const Json* first = nullptr;
  for (const auto& [numbers, frame] : frames_by_numbers(file, names)) {
    const auto found = of_number.find(numbers.back());
    if (found == of_number.end())
      refuse(file, "has no camera of image ", numbers.back(), ": expected one for ", depth[frame].string());
    const Json& camera = *found->second;
    const bool is_whole = camera.is_object() && camera.contains("cam_K") && camera["cam_K"].is_array() &&
                          camera["cam_K"].size() == 9 && camera.contains("depth_scale");
    if (!is_whole) refuse(file, "image ", numbers.back(), ": expected cam_K, 9 numbers, and depth_scale");
    if (!first) first = &camera;
    if (camera["cam_K"] != (*first)["cam_K"] || camera["depth_scale"] != (*first)["depth_scale"])
      refuse(file, "image ", numbers.back(),
             " has another camera than the first: expected images of one camera, as a recording has");
  }
  std::array<double, 10> k{};
  for (std::size_t i = 0; i < k.size(); ++i) {
    const Json& value = i < 9 ? (*first)["cam_K"][i] : (*first)["depth_scale"];
    k[i] = value.is_number() ? value.get<double>() : std::nan("");
  }
  if (!(k[0] > 0 && k[4] > 0 && k[9] > 0 && std::isfinite(k[0] + k[2] + k[4] + k[5] + k[9])) || k[1] != 0)
    refuse(file, "cam_K = ", shown((*first)["cam_K"]), ", depth_scale = ", shown((*first)["depth_scale"]),
           ": expected focal lengths, a centre and a scale, without skew");
  ImageCamera result =
      camera_of_images(depth, {0, 0, k[0], k[4], k[2], k[5]}, k[9] / 1000, "scene_camera.json");
  result.colour_registered = true;
  return result;
}

ImageCamera scannet_camera(const fs::path& file, const std::vector<fs::path>& depth) {
  const std::string text = read_input_text(file, "expected a 4 x 4 matrix of intrinsics");
  std::vector<double> k;
  for_each_line(text, [&](std::size_t, std::string_view line) {
    for (const std::string_view word : words_of_line(line))
      k.push_back(number_of_word(word).value_or(std::nan("")));
  });
  if (k.size() != 16 || !(k[0] > 0 && k[5] > 0 && std::isfinite(k[0] + k[2] + k[5] + k[6])) || k[1] != 0)
    refuse(file, "expected 16 numbers, a matrix of focal lengths and centre, without skew");
  return camera_of_images(depth, {0, 0, k[0], k[5], k[2], k[6]}, kMillimetre_m, file.filename().string());
}

bool has_png(const fs::path& folder) {
  return fs::is_directory(folder) && !files_in_order(folder, ".png").empty();
}

// Lists depth images at a steady rate. colours: the folder of colour images.
RecordingIndex index_images(const std::vector<fs::path>& depth, const ImageCamera& camera,
                            const fs::path& camera_file, const fs::path& colours) {
  RecordingIndex index;
  set_camera(camera, camera_file, index);
  append_frames(depth, index);
  require_target(colours);
  const bool has_colours = fs::is_directory(colours) && !fs::is_empty(colours);
  if (!has_colours) return index;
  if (!camera.colour_registered) {
    note_unused_colours(colours.filename().string(), kNotRegistered, index);
    return index;
  }
  const std::vector<fs::path> images = colour_images(depth, colours);
  for (std::size_t j = 0; j < depth.size(); ++j) index.frames[j].colour = images[j];
  return index;
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

ImageCamera read_camera_file(const fs::path& file) {
  const Json json = parse_camera_file(file);
  ImageCamera result;
  result.source = file.filename().string();
  CameraIntrinsics& camera = result.camera;
  camera.width = pixel_count(file, json, "width"), camera.height = pixel_count(file, json, "height");
  camera.fx = number(file, json, "fx", true), camera.fy = number(file, json, "fy", true);
  camera.cx = number(file, json, "cx", false), camera.cy = number(file, json, "cy", false);
  result.metres_per_unit = number(file, json, "depth_scale_m", true);
  if (json.contains("frame_rate_hz")) result.frame_rate_hz = frame_rate(file, json);
  if (const auto found = json.find("colour_registered"); found != json.end()) {
    if (!found->is_boolean()) refuse(file, "colour_registered = ", shown(*found), ": expected true, false");
    result.colour_registered = found->get<bool>();
  }
  if (const auto found = json.find("depth_along"); found != json.end()) {
    if (*found != "axis" && *found != "ray")
      refuse(file, "depth_along = ", shown(*found), ": expected \"axis\", \"ray\"");
    result.depth_along_ray = *found == "ray";
  }
  return result;
}

double read_frame_rate(const fs::path& file) {
  return frame_rate(file, parse_camera_file(file));
}

std::vector<StampedFile> read_stamped_list(const std::filesystem::path& list) {
  const std::string text = read_input_text(list, "expected lines 'timestamp filename'");
  std::vector<StampedFile> files;
  for_each_line(without_byte_order_mark(text), [&](std::size_t number, std::string_view line) {
    if (line.ends_with('\r')) line.remove_suffix(1);  // files of other systems
    const std::vector<std::string_view> words = words_of_line(line);
    if (words.empty() || words[0].front() == '#') return;
    const std::string where = list.string() + ":" + std::to_string(number), stamp(words[0]);
    const double stamp_s = read_stamp(where, stamp);
    if (words.size() != 2)
      refuse(where, "'", line.substr(0, 64), "': expected one timestamp and one file name");
    if (!files.empty() && stamp_s <= files.back().stamp_s)
      refuse(where, "timestamp ", stamp, ": expected above that of the line before");
    files.push_back({stamp_s, list.parent_path() / words[1]});
    const std::filesystem::path& file = files.back().file;
    if (!std::filesystem::is_regular_file(file)) refuse(where, "no file ", file.string());
  });
  if (files.empty()) refuse(list.string(), "lists no file: expected lines 'timestamp filename'");
  return files;
}

std::vector<RecordedFrame> associate_stamps(const std::vector<StampedFile>& depth,
                                            const std::vector<StampedFile>& colour) {
  constexpr double kMaxApart_s = 0.02;  // the tolerance of the benchmark's own association
  std::vector<RecordedFrame> frames;
  auto first = colour.begin();
  for (const StampedFile& image : depth) {
    RecordedFrame frame{image.stamp_s - depth.front().stamp_s, image.file, {}};
    double nearest_s = kMaxApart_s;
    // The stamps increase, so a colour image that is too early for this depth image is too early for all
    // later ones.
    while (first != colour.end() && image.stamp_s - first->stamp_s > kMaxApart_s) ++first;
    for (auto other = first; other != colour.end() && other->stamp_s - image.stamp_s <= kMaxApart_s;
         ++other) {
      const double off_s = std::abs(other->stamp_s - image.stamp_s);
      if (off_s <= nearest_s) nearest_s = off_s, frame.colour = other->file;
    }
    frames.push_back(frame);
  }
  return frames;
}

double mean_rate_hz(const std::string& file, std::size_t frames, double last_s) {
  if (frames < 2) return kNominalRate_hz;
  const double rate_hz = static_cast<double>(frames - 1) / last_s;
  if (rate_hz > kMaxFrameRate_hz)
    refuse(file, "has timestamps of more than 10000 frames a second: expected seconds");
  return rate_hz;
}

void append_frames(const std::vector<fs::path>& files, RecordingIndex& index) {
  for (std::size_t j = 0; j < files.size(); ++j)
    index.frames.push_back({static_cast<double>(j) / index.frame_rate_hz, files[j], {}});
  const std::string equal = equal_numbers(files);
  if (!equal.empty()) index.notes.push_back({"equal numbers", equal});
}

DepthImage read_depth_image(const fs::path& file, double metres_per_unit) {
  constexpr double kNoLimit_m = std::numeric_limits<double>::infinity();
  if (has_ending(file, ".npy")) return read_depth_npy(file, metres_per_unit, kNoLimit_m);
  DepthImage depth = read_depth_png(file, metres_per_unit, kNoLimit_m);
  // The largest value is no measurement: 7-Scenes marks missing pixels with it.
  std::ranges::replace(depth.z_m, 65535 * metres_per_unit, std::numeric_limits<double>::quiet_NaN());
  return depth;
}

std::optional<RecordingIndex> index_image_folder(const fs::path& folder) {
  if (fs::exists(folder / "depth.txt")) return index_tum(folder);
  const fs::path own = folder / "camera.json", of_bop = folder / "scene_camera.json";
  if (!fs::is_directory(folder / "depth")) {
    std::vector<fs::path> depth = files_in_order(folder, ".png");
    std::erase_if(depth, [](const fs::path& file) { return file.stem().extension() != ".depth"; });
    if (depth.empty()) return {};
    const ImageCamera kinect = {{640, 480, 585, 585, 320, 240}, kMillimetre_m, false, "default of 7-Scenes"};
    RecordingIndex index = fs::exists(own) ? index_images(depth, read_camera_file(own), own, {})
                                           : index_images(depth, kinect, {}, {});
    if (files_in_order(folder, ".png").size() > depth.size())
      note_unused_colours("*.color.png", "the images of 7-Scenes are not registered", index);
    return index;
  }
  std::vector<fs::path> depth = files_in_order(folder / "depth", ".png");
  const std::vector<fs::path> arrays = files_in_order(folder / "depth", ".npy");
  if (!depth.empty() && !arrays.empty())
    refuse(folder / "depth", "holds .png and .npy files: expected one kind");
  if (depth.empty()) depth = arrays;
  fs::path of_scannet = folder / "intrinsic" / "intrinsic_depth.txt";
  if (!fs::exists(of_scannet)) of_scannet = folder / "intrinsics_depth.txt";
  const bool is_bop = fs::exists(of_bop), is_scannet = fs::exists(of_scannet);
  if (!fs::exists(own) && !is_bop && !is_scannet)
    refuse(own,
           "is missing: depth images need {width, height, fx, fy, cx, cy, depth_scale_m, frame_rate_hz}, or "
           "scene_camera.json (BOP) or intrinsic/intrinsic_depth.txt (ScanNet)");
  if (depth.empty()) refuse(folder / "depth", "holds no .png and no .npy file");
  const fs::path colours = folder / (is_scannet && !is_bop ? "color" : "rgb");
  if (fs::exists(own)) {
    const ImageCamera camera = read_camera_file(own);
    if (camera.frame_rate_hz == 0 && !is_bop && !is_scannet) refuse(own, "has no key 'frame_rate_hz'");
    return index_images(depth, camera, own, colours);
  }
  if (is_bop) {
    ImageCamera camera = bop_camera(of_bop, depth);
    const bool is_unread = fs::is_directory(colours) && !has_png(colours);
    RecordingIndex index = index_images(depth, camera, of_bop, is_unread ? fs::path() : colours);
    if (is_unread) note_unused_colours("rgb", "they are no PNG files", index);
    return index;
  }
  RecordingIndex index = index_images(depth, scannet_camera(of_scannet, depth), of_scannet, {});
  if (fs::is_directory(colours))
    note_unused_colours("color", "the images of ScanNet are not registered", index);
  return index;
}

}  // namespace remote_touch
