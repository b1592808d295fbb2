// A recording of a box before a camera, with its true mesh: the camera measures every depth with one error.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/kernels/isa.h"
#include "runners/experiment/catalog/experiment.h"
#include "scenarios/recordings/recorded_scene.h"
#include "tests/support/test_files.h"

namespace remote_touch::true_wall {

// The front of the box, 0.2 m wide and high, fills the middle of the image. Behind it nothing is measured.
constexpr int kWidth = 160, kHeight = 120, kFrames = 6;
constexpr double kFocal_px = 200, kFront_m = 0.5, kHalf_m = 0.1;
// The measured front is nearer than the true one.
constexpr double kError_m = 0.002;

inline std::string camera_json() {
  return R"({"width": 160, "height": 120, "fx": 200, "fy": 200, "cx": 80, "cy": 60,)"
         R"( "depth_scale_m": 0.0001, "frame_rate_hz": 30, "colour_registered": false})";
}

// The box with its front at z = 0 in the frame of the object, and its corners counter-clockwise from outside.
inline std::string box_obj() {
  return "v -0.1 -0.1 0\nv 0.1 -0.1 0\nv 0.1 0.1 0\nv -0.1 0.1 0\n"
         "v -0.1 -0.1 0.1\nv 0.1 -0.1 0.1\nv 0.1 0.1 0.1\nv -0.1 0.1 0.1\n"
         "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
}

// Writes the recording. In each frame the box is farther to the right by step_m.
inline void write(const TestFolder& folder, double step_m = 0) {
  folder.write("wall/camera.json", camera_json());
  folder.write("wall/truth/box.obj", box_obj());
  std::string poses;
  for (int frame = 0; frame < kFrames; ++frame) {
    const double x_m = frame * step_m, measured_m = kFront_m - kError_m;
    poses += "1 0 0 " + std::to_string(x_m) + " 0 1 0 0 0 0 1 " + std::to_string(kFront_m) + " 0 0 0 1\n";
    std::vector<std::uint16_t> depth;
    for (int v = 0; v < kHeight; ++v)
      for (int u = 0; u < kWidth; ++u) {
        const double x = (u - 80) / kFocal_px * measured_m - x_m, y = (v - 60) / kFocal_px * measured_m;
        const bool is_box = std::abs(x) < kHalf_m && std::abs(y) < kHalf_m;
        depth.push_back(is_box ? static_cast<std::uint16_t>(std::lround(measured_m / 1e-4)) : 0);
      }
    folder.write_png("wall/depth/000" + std::to_string(frame) + ".png", kWidth, kHeight, PNG_FORMAT_LINEAR_Y,
                     depth.data());
  }
  folder.write("wall/truth/poses.txt", poses);
}

inline nlohmann::ordered_json scenario(const TestFolder& folder) {
  return {{"name", "recording"}, {"path", (folder / "wall").string()}, {"truth", "mesh"}};
}

// The recording as a scene.
class WallScene {
 public:
  explicit WallScene(const TestFolder& folder)
      : owner_(Experiment::from_json(nlohmann::ordered_json{{"scenario", scenario(folder)},
                                                            {"renderer", {{"name", "proxy"}}},
                                                            {"trajectory", {{"name", "poses"}}},
                                                            {"duration_s", 1}})
                   .build_scenario(kernels_for(best_isa()))) {}
  const RecordedScene& operator*() const { return dynamic_cast<const RecordedScene&>(*owner_); }

 private:
  std::unique_ptr<Scenario> owner_;
};

}  // namespace remote_touch::true_wall
