// Recordings of depth cameras on disk: their frames, the times of capture, and each frame as a cloud.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/cloud/point_cloud.h"

namespace remote_touch {

struct RecordedFrame {
  double captured_s = 0;         // since the first frame
  std::filesystem::path depth;   // a depth PNG or a PCD file
  std::filesystem::path colour;  // colour image registered to the depth image; empty: none
};

struct RecordingIndex {
  enum class Kind { depth_png, pcd };
  Kind kind = Kind::depth_png;
  CameraIntrinsics camera;     // pcd: as fitted to the first file; all 0 where that has no image layout
  double metres_per_unit = 0;  // of the depth PNG; pcd: 1
  double frame_rate_hz = 0;
  std::vector<RecordedFrame> frames;  // at least one, captured_s strictly increasing
  std::string description;            // one line
  // Files that were read in addition to the frames, if they exist: camera.json, depth.txt, rgb.txt.
  std::vector<std::filesystem::path> texts;
};

// The layout of path is the first of these that fits:
// - DIR/depth.txt (TUM RGB-D): its lists as in tum_layout.h, at the mean rate of the stamps (one: 30 Hz).
//   Without DIR/camera.json the camera is the benchmark's: 640 x 480 pixels, f = 525, c = (319.5, 239.5),
//   5000 units per metre, colour registered.
// - DIR/depth/N.png: needs DIR/camera.json; DIR/rgb/N.png is used if that says colour_registered.
// - DIR/*.pcd: at the frame_rate_hz of DIR/camera.json, else 30 Hz. Nothing else of camera.json is used, and
//   times in file names are not either.
// - FILE.pcd: one frame.
// Frames are in the order of the file names; if all names are numbers, in the order of the numbers.
//
// camera.json: {width, height, fx, fy, cx, cy, depth_scale_m, frame_rate_hz}, optionally colour_registered
// (default false); other keys are refused. Pixels, metres per unit, hertz.
//
// Throws InputError about the file (with ":line" for a text file) if a part is missing or wrong. Depth images
// are opened by read_frame only; of PCD files the first is read here.
RecordingIndex index_recording(const std::filesystem::path& path);
// The same without opening any PCD file: no description, and no camera for kind pcd.
RecordingIndex list_recording(const std::filesystem::path& path);

// One frame as an organised cloud: the camera frame is the world frame, pixel (u, v) is point v * width + u.
// What is missing or farther than max_depth_m is NaN. A PCD file may also hold a cloud that is not organised.
// Pre: frame < index.frames.size(). Throws InputError if a file is unusable or not of the camera's size.
PointCloud read_frame(const RecordingIndex& index, std::size_t frame, double max_depth_m);

}  // namespace remote_touch
