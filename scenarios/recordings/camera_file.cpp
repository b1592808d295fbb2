#include "scenarios/recordings/camera_file.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "scenarios/recordings/recording.h"
#include "scenarios/text_files/json_text.h"
#include "scenarios/text_files/refuse.h"
#include "scenarios/text_files/text_file.h"

namespace remote_touch {
namespace {

namespace fs = std::filesystem;

Json parse_camera_file(const fs::path& file) {
  static const Json kKeys = {
      "width",      "height", "fx", "fy", "cx", "cy", "depth_scale_m", "frame_rate_hz", "colour_registered",
      "depth_along"};
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

}  // namespace

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

}  // namespace remote_touch
