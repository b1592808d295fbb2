// Recordings of depth cameras on disk: their frames, the times of capture, and each frame as a cloud.
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/geometry/point_cloud.h"
#include "scenarios/interface/scenario.h"
#include "scenarios/recordings/bag_choice.h"

namespace remote_touch {

class BagFrames;

// Equal to the fastest haptic rate. At a higher rate more than one frame would arrive in a tick.
inline constexpr double kMaxFrameRate_hz = 10000;
// Rate of the Kinect class, for a recording that states none.
inline constexpr double kNominalRate_hz = 30;

struct RecordedFrame {
  double captured_s = 0;         // since the first frame
  std::filesystem::path depth;   // a depth image or a PCD file; empty for a bag
  std::filesystem::path colour;  // colour image registered to the depth image; empty: none
};

// Pose of the camera of a frame.
struct FrameCamera {
  // Pose of the camera in the coordinates of a PCD file: its VIEWPOINT if that is used, see read_pcd();
  // otherwise the identity.
  RigidTransform X_FC = RigidTransform::Identity();
  bool has_unused_viewpoint = false;  // see PcdCloud
};

struct RecordingIndex {
  enum class Kind { depth_image, pcd, bag };
  Kind kind = Kind::depth_image;
  // All 0 for pcd and for clouds of a bag, because read_frame() fits a camera to each frame.
  CameraIntrinsics camera;
  std::string camera_source;     // origin of the camera, for the user: "camera.json"
  double metres_per_unit = 0;    // size of one unit of a depth image; 1 for other kinds
  bool depth_along_ray = false;  // depth images hold distances from the camera's centre
  double frame_rate_hz = 0;
  // True if captured_s are stamps; frame_rate_hz is then their mean rate. Otherwise frame j is captured at
  // j / frame_rate_hz.
  bool is_stamped = false;
  // Stamp of the first frame on the clock of the recording; NaN: not known.
  double first_stamp_s = std::numeric_limits<double>::quiet_NaN();
  std::vector<RecordedFrame> frames;  // one frame or more, captured_s strictly increasing
  std::string name;                   // name of the folder or file, without the folders above it
  // Files that were read in addition to the frames: camera.json, depth.txt, rgb.txt and the like.
  std::vector<std::filesystem::path> texts;
  std::shared_ptr<const BagFrames> bag;  // set if kind is bag
  // Notes on an assumed camera, on colours that are not used, and on names with equal numbers.
  std::vector<Note> notes;
};

// Lists the frames of a recording. Its layout is the first of these that fits path:
// - a bag, see bags/bag_file.h: the messages of one topic, as the choice says, see bag_frames.h. Its rate is
//   the mean rate of the stamps (30 Hz for a single frame).
// - a folder of depth images in the layout of this program, TUM, ScanNet, 7-Scenes or BOP: image_folders.h.
// - DIR/*.pcd: at the frame_rate_hz of DIR/camera.json, else 30 Hz. The other values of camera.json and times
//   in file names are not used.
// - FILE.pcd: one frame.
// Frames are in the order of the file names, in which numbers are compared as numbers: sort_by_name().
// Endings may be in capital letters. Hidden files, whose names begin with a dot, are ignored.
//
// Throws InputError about the file (with ":line" for a text file) if a part is missing or wrong. No frame is
// opened here, except the first depth image of a bag, or of a layout that does not state its size.
RecordingIndex index_recording(const std::filesystem::path& path, const BagChoice& choice = {});

// One line for the user: "office: 71 frame(s) from depth PNG at RATE, 640 x 480 pixels, f = 525, 525, c =
// 319.5, 239.5 (camera.json)".
std::string description(const RecordingIndex& index, const std::string& rate);

// Returns the name of a frame for a message about it: its file, or its message in a bag.
std::string frame_name(const RecordingIndex& index, std::size_t frame);

// Returns the name of the file of each frame, or its number in a bag. The numbers in it are those of the
// frame's masks and poses.
std::vector<std::string> frame_names(const RecordingIndex& index);

// Returns one frame as an organised cloud: the camera frame is the world frame, pixel (u, v) is point
// v * width + u. Missing pixels are NaN, and so are pixels whose depth is above max_depth_m. A PCD file or a
// bag may also hold a cloud that is no image: max_depth_m does not apply to it. Writes the camera of the
// frame to `camera` unless it is null. Pre: frame < index.frames.size(). Throws InputError if a file cannot
// be used or its image does not have the camera's size.
PointCloud read_frame(const RecordingIndex& index, std::size_t frame, double max_depth_m,
                      FrameCamera* camera = nullptr);

}  // namespace remote_touch
