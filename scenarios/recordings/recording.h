// Recordings of depth cameras on disk: their layouts and frames, the times of capture, and each frame as a
// cloud.
#pragma once

#include <compare>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "core/points/point_cloud.h"
#include "scenarios/recordings/bag_file.h"
#include "scenarios/simulated/scenario.h"

namespace remote_touch {

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
// - a bag, see bag_file.h: the messages of one topic, as the choice says. Its rate is the mean rate of the
//   stamps (30 Hz for a single frame).
// - a folder of depth images in the layout of this program, TUM, ScanNet, 7-Scenes or BOP.
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

// The input files of a run: recordings, images, meshes, sessions and contacts. A result depends on them in
// addition to its configuration.

// A file or folder that settings name, or the part of a recording that they choose. Making one does not
// search the file system, so that a sweep can list the inputs of all its cells at no cost.
struct InputPart {
  std::string path;
  int first_frame = 0;
  int last_frame = -1;            // -1: the last frame of the recording
  bool with_truth = false;        // the run also reads the folder truth/, if the recording has one
  std::string camera_poses = {};  // a file or folder of poses in it that the run also reads; empty: none
  auto operator<=>(const InputPart&) const = default;
};

// The file or folder is not on this machine. Figures that need it are reported as not run. A damaged
// recording throws an InputError that is no MissingInput.
class MissingInput : public InputError {
 public:
  using InputError::InputError;
};

// Sets the data folder, below which relative paths are searched that do not exist in the current folder.
// Empty (the default) means that there is none. The setting holds for the whole program and must precede the
// first search. The Python package sets it to REMOTE_TOUCH_DATA.
void set_data_folder(const std::string& folder);

// Returns the path itself if it exists, else the path below the data folder. Throws MissingInput if
// neither exists or can be reached, and InputError for a pipe or a device, which would never end.
std::string find_input(const std::string& path);

// Returns the searched locations, in the words of the command line: "here or below REMOTE_TOUCH_DATA =
// /data".
std::string input_places();

// The frames of the part, first to last. frames_of() throws InputError if the recording has fewer.
struct FrameRange {
  int first = 0, last = 0;
};
FrameRange frames_of(const InputPart& part, const RecordingIndex& recording);

// Returns the files from which the part's frames are made, each once, sorted by name. For a single file, such
// as a PNG, a mesh or a live session, it is the file itself. For a recording in a folder they are the depth
// images or PCD files of the part, the colour images registered to them, those of camera.json, depth.txt and
// rgb.txt that are used, the poses of the camera, and the files of the truth. For a bag they are all its
// files, because its frames are not counted here. Throws InputError if the recording is not there, its lists
// or camera.json cannot be used, it has fewer frames, or one of the files is a folder, a pipe or a device,
// a text above 16 MiB or a mesh above 2 GiB. Images and PCD files are not opened.
struct InputFile {
  std::string name;            // relative to the recording's folder, or to the folder of a single PCD file
  std::filesystem::path file;  // path with which the file is opened
};
std::vector<InputFile> files_of(const InputPart& part);

// Returns the largest distance, in pixels along one axis, between the pixel of a measured point and the pixel
// at which the camera sees that point. Infinite if a point is behind the camera. pre: the cloud has a point
// per pixel.
double largest_error_px(const PointCloud& cloud, const RigidTransform& X_CW, const CameraIntrinsics& camera);

// Layout that all frames of a recording share: images of one camera, or organised clouds without a camera, or
// clouds in no order.
struct FrameLayout {
  bool is_organised = false;
  // Camera of images; camera of organised clouds, if a pinhole explains their first frame.
  std::optional<CameraIntrinsics> camera;
};

FrameLayout layout_of(const PointCloud& cloud);

// Checks that a later frame, in its camera's frame, has the layout. Adds the camera of the layout if the
// frame has none of its own, and removes the frame's camera if the layout has none. Throws InputError about
// the subject in these cases:
// - The layout has a camera, and the frame has another number of rows or columns. A frame without any point
//   becomes an image of holes.
// - The layout has a camera, and it sees a point off its pixel: by 1 px or more if the frame has a camera of
//   its own, which was fitted with residuals of up to 0.5 px; by 0.5 px or more if it has none, because it
//   has too few points for a fit. A frame whose VIEWPOINT is not used has its points in coordinates of the
//   file and usually fails here.
// - The layout is organised without a camera, and the frame is neither organised nor empty. Its size may
//   differ, as with a lidar, because the rows of one frame are not related to those of another.
// - The layout is a cloud in no order, and the frame is organised. Its size may differ.
void conform(const FrameLayout& layout, const std::string& subject, PointCloud& cloud);

// Sets the points of an image beyond max_depth_m, along the axis of its camera, to NaN. A cloud without a
// camera has no depth and is not changed. Pre: the cloud is in its camera's frame.
void drop_beyond(double max_depth_m, PointCloud& cloud);

// The images or clouds of a folder in order, and the colour image that belongs to each depth image.

// Returns the files with this extension (lower case, with its dot; the files may have it in capital letters),
// in the order of sort_by_name(). Hidden files are ignored. Throws InputError about a link to a file that
// does not exist.
std::vector<std::filesystem::path> files_in_order(const std::filesystem::path& folder,
                                                  const std::string& extension);

// Returns the colour image of each depth image, or an empty path. If any colour image has the name of a depth
// image, up to the ending, images are paired by name, and a depth image without a namesake has no colour
// image. Otherwise they are paired by the numbers in their names: frame-000007.color.png belongs to
// frame-000007.depth.png. Throws InputError, which names an image of each kind, if two colour images have the
// same numbers, two depth images have the same partner, or no depth image has a partner. Throws InputError if
// the folder holds only files of other kinds. If there is no folder, there are no colour images.
std::vector<std::filesystem::path> colour_images(const std::vector<std::filesystem::path>& depth,
                                                 const std::filesystem::path& folder);

// The camera of a folder of depth images: the file camera.json.

struct ImageCamera {
  CameraIntrinsics camera;
  double metres_per_unit = 0;  // size of one unit of the depth images
  bool colour_registered = false;
  std::string source;            // origin of the camera, for the user: "camera.json"
  double frame_rate_hz = 0;      // 0: not stated
  bool depth_along_ray = false;  // the images hold distances from the camera's centre
};

// camera.json is an object with the keys width, height, fx, fy, cx, cy, depth_scale_m, and, if wanted,
// frame_rate_hz, colour_registered (default false) and depth_along ("axis", the default, or "ray"). Pixels,
// metres per unit, hertz. Other keys are refused, so that a misspelt one is found. Throws InputError about
// the file if it is not as above.
ImageCamera read_camera_file(const std::filesystem::path& file);

// Returns frame_rate_hz only, which is then required, while width and the like may be missing.
double read_frame_rate(const std::filesystem::path& file);

// The lists of a TUM RGB-D folder (depth.txt, rgb.txt), and which colour image belongs to which depth image.

// One line of a list; the stamp counts from an arbitrary origin.
struct StampedFile {
  double stamp_s = 0;
  std::filesystem::path file;
};

// Reads lines "timestamp_s filename", relative to the list's folder, and # comments. Throws InputError about
// a line if it is anything else, if the stamps do not strictly increase or if the file does not exist. Throws
// InputError about the list if it names no file.
std::vector<StampedFile> read_stamped_list(const std::filesystem::path& list);

// Returns a frame for each depth image, with captured_s counted from the first one. Its colour image is the
// one with the nearest stamp within 0.02 s (the last one of several equally near), or none. Pre: depth is not
// empty.
std::vector<RecordedFrame> associate_stamps(const std::vector<StampedFile>& depth,
                                            const std::vector<StampedFile>& colour);

// Lists the frames of a folder of depth images, in the layout of this program or of a public data set. The
// layout is the first of these whose files it has:
// - TUM RGB-D: depth.txt, and rgb.txt for colours, see above; 5000 units per metre. The rate is the
//   mean rate of the stamps (30 Hz for a single frame). The camera is that of freiburg1, 2 or 3, if the
//   folder's name or a comment in depth.txt names it, else the benchmark's default (f = 525), with a note.
//   Colours are registered.
// - this program: depth/*.png and camera.json; colours in rgb/.
// - BOP: depth/*.png and scene_camera.json; depth_scale is millimetres per unit; colours in rgb/.
// - ScanNet: depth/*.png and intrinsic/intrinsic_depth.txt, or intrinsics_depth.txt; millimetres.
// - 7-Scenes: *.depth.png; millimetres, f = 585, c = (320, 240).
// Depth images may be NumPy files (depth/*.npy, depth_images.h) in every layout but that of 7-Scenes.
// A camera.json replaces the camera and the unit of every layout, and states whether colours are registered,
// whether depths are along the axis or the rays and, except for TUM, the rate, which is otherwise 30 Hz.
// Colours that are there but not used are a note. Images are in the order of sort_by_name(); colours are
// paired as above.
//
// Returns nothing for a folder of another kind. Throws InputError about the file if a part is missing or
// wrong, and about scene_camera.json if the images of a scene have several cameras.
std::optional<RecordingIndex> index_image_folder(const std::filesystem::path& folder);

// Returns the mean rate of stamped frames; the nominal rate for one frame, because one stamp states no rate.
// Throws InputError about the file if it is above kMaxFrameRate_hz.
double mean_rate_hz(const std::string& file, std::size_t frames, double last_s);

// Appends frames at the steady rate of the index: frame j is captured at j / rate. Names with equal numbers
// are a note. Pre: the files are in the order of sort_by_name().
void append_frames(const std::vector<std::filesystem::path>& files, RecordingIndex& index);

// Reads a depth image, a NumPy file or a PNG. Missing pixels are NaN; they have the value 0 or, in an image
// of 16-bit integers, 65535. Throws InputError as read_depth_npy() and read_depth_png().
DepthImage read_depth_image(const std::filesystem::path& file, double metres_per_unit);

}  // namespace remote_touch
