// A recording whose true surface and whose camera's error are known, written by a test.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/test_files.h"

namespace remote_touch::recorded_wall {

inline constexpr int kWidth = 64, kHeight = 48;
inline constexpr double kFocal = 400, kDepthError_m = 0.002;
// The camera sees the wall at 45 degrees, so that an error of depth counts less across the wall.
inline const double kCameraError_m = kDepthError_m / std::sqrt(2.0);

// The wall is the plane z = 0.5 m + x, its normal towards the camera is (1, 0, -1) / sqrt(2), and pixel
// (32, 24) sees (0, 0, 0.5). Every depth is measured 2 mm too small, so the measured surface is in front of
// the wall. There is one frame, with a hole in one column. `truth/` has the wall as a sheet, 3 mm uncertain.
// Returns the path of the recording.
inline std::string write(const TestFolder& folder, int hole_column = kWidth - 1) {
  std::vector<std::uint16_t> units;  // unit: 0.01 mm
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u) {
      const double depth_m = 0.5 / (1 - (u - 32) / kFocal) - kDepthError_m;
      units.push_back(u == hole_column ? 0 : static_cast<std::uint16_t>(std::lround(depth_m * 1e5)));
    }
  folder.write_png("wall/depth/0000.png", kWidth, kHeight, PNG_FORMAT_LINEAR_Y, units.data());
  folder.write("wall/camera.json", R"({"width": 64, "height": 48, "fx": 400, "fy": 400, "cx": 32, "cy": 24,
                                       "depth_scale_m": 1e-5, "frame_rate_hz": 30})");
  folder.write("wall/truth/wall.obj",
               "v -0.2 -0.2 0.3\nv 0.2 -0.2 0.7\nv 0.2 0.2 0.7\nv -0.2 0.2 0.3\n"
               "f 1 3 2\nf 1 4 3\n");
  folder.write("wall/truth/poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n");
  folder.write("wall/truth/truth.json",
               R"({"objects": [{"name": "wall", "mesh": "wall.obj", "poses": "poses.txt", "closed": false}],
                   "uncertainty_m": 0.003})");
  return (folder / "wall").string();
}

// Section `scenario` of an experiment, as JSON. more: further members, with a comma before each.
inline std::string scenario(const std::string& path, const std::string& more = "") {
  return R"({"name": "recording", "path": ")" + path + "\"" + more + "}";
}

// Section `trajectory`: the hand comes along the normal, and stays 10 mm behind the true wall.
inline constexpr const char* kPress = R"({"name": "waypoints", "waypoints":
  [[0.0141421, 0, 0.4858579, 0], [-0.0070711, 0, 0.5070711, 0.2]]})";

}  // namespace remote_touch::recorded_wall
