// Folders of depth images in the layouts that are read: that of this program, and those of public data sets.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/points/point_cloud.h"
#include "scenarios/recordings/recording.h"

namespace remote_touch {

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

// Lists the frames of a folder. The layout is the first of these whose files it has:
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
