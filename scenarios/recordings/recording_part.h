// The location of a recording or an image, and the files of it that a run reads: a result depends on them in
// addition to its configuration.
#pragma once

#include <compare>
#include <filesystem>
#include <string>
#include <vector>

#include "core/parameters/input_error.h"
#include "scenarios/recordings/recording.h"

namespace remote_touch {

// Part of a recording, as named in settings. Making one does not search the file system, so that a sweep can
// list the parts of all its cells at no cost.
struct RecordingPart {
  std::string path;
  int first_frame = 0;
  int last_frame = -1;            // -1: the last frame of the recording
  bool with_truth = false;        // the run also reads the folder truth/, if the recording has one
  std::string camera_poses = {};  // a file or folder of poses in it that the run also reads; empty: none
  auto operator<=>(const RecordingPart&) const = default;
};

// The recording is not on this machine. Figures that need it are reported as not run. A damaged recording
// throws an InputError that is no MissingRecording.
class MissingRecording : public InputError {
 public:
  using InputError::InputError;
};

// Sets the data folder, below which relative paths are searched that do not exist in the current folder.
// Empty (the default) means that there is none. The setting holds for the whole program and must precede the
// first search. The Python package sets it to REMOTE_TOUCH_DATA.
void set_data_folder(const std::string& folder);

// Returns the path itself if it exists, else the path below the data folder. Throws MissingRecording if
// neither exists or can be reached, and InputError for a pipe or a device, which would never end.
std::string find_recording(const std::string& path);

// Returns the searched locations, in the words of the command line: "here or below REMOTE_TOUCH_DATA =
// /data".
std::string recording_places();

// The frames of the part, first to last. frames_of() throws InputError if the recording has fewer.
struct FrameRange {
  int first = 0, last = 0;
};
FrameRange frames_of(const RecordingPart& part, const RecordingIndex& recording);

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
std::vector<InputFile> files_of(const RecordingPart& part);

}  // namespace remote_touch
