// Folders of depth images in the layouts that are read: that of this program, and those of public data sets.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/camera.h"
#include "scenarios/recordings/recording.h"

namespace remote_touch {

// Lists the frames of a folder. The layout is the first of these whose files it has:
// - TUM RGB-D: depth.txt, and rgb.txt for colours, see tum_layout.h; 5000 units per metre. The rate is the
//   mean rate of the stamps (30 Hz for a single frame). The camera is that of freiburg1, 2 or 3, if the
//   folder's name or a comment in depth.txt names it, else the benchmark's default (f = 525), with a note.
//   Colours are registered.
// - this program: depth/*.png and camera.json; colours in rgb/.
// - BOP: depth/*.png and scene_camera.json; depth_scale is millimetres per unit; colours in rgb/.
// - ScanNet: depth/*.png and intrinsic/intrinsic_depth.txt, or intrinsics_depth.txt; millimetres.
// - 7-Scenes: *.depth.png; millimetres, f = 585, c = (320, 240).
// Depth images may be NumPy files (depth/*.npy, depth_npy.h) in every layout but that of 7-Scenes.
// A camera.json replaces the camera and the unit of every layout, and states whether colours are registered,
// whether depths are along the axis or the rays and, except for TUM, the rate, which is otherwise 30 Hz.
// Colours that are there but not used are a note. Images are in the order of sort_by_name(); colours are
// paired as in folder_files.h.
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
