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

// Part of a recording, as named in settings. The file system is not searched, so that a sweep can list the
// parts of all its cells at no cost.
struct RecordingPart {
  std::string path;
  int first_frame = 0;
  int last_frame = -1;  // -1: the last frame of the recording
  auto operator<=>(const RecordingPart&) const = default;
};

// A recording that is not on this machine: figures that need it are reported as not run. A damaged one is an
// error.
class MissingRecording : public InputError {
 public:
  using InputError::InputError;
};

// The folder below which relative paths are searched that do not exist here; empty (the default): none. It
// holds for the whole program and is set before the first search: the command line takes REMOTE_TOUCH_DATA.
void set_data_folder(const std::string& folder);

// Finds a recording: the path itself, else below the data folder. Throws MissingRecording when it is in
// neither place.
std::string find_recording(const std::string& path);

// The searched locations, in the words of the command line: "here or below REMOTE_TOUCH_DATA = /data".
std::string recording_places();

// The frames of the part, first to last. Throws InputError when the recording has fewer.
struct FrameRange {
  int first = 0, last = 0;
};
FrameRange frames_of(const RecordingPart& part, const RecordingIndex& recording);

// The files from which the part's frames are made, each once, sorted by name: a single PNG or mesh itself; or
// the depth images or PCD files, the colour images registered to them, and those of camera.json, depth.txt
// and rgb.txt that are used; or the files of a bag, as a whole: its frames are not counted here. Throws
// InputError when the recording is not there, its lists or camera.json cannot be used, or it has fewer
// frames; images and PCD files are not opened.
struct InputFile {
  std::string name;            // relative to the recording's folder, or to the folder of a single PCD file
  std::filesystem::path file;  // path with which the file is opened
};
std::vector<InputFile> files_of(const RecordingPart& part);

}  // namespace remote_touch
