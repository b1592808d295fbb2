// Where a recording or an image is, and which of its files a run reads: what a result depends on beside its
// configuration.
#pragma once

#include <compare>
#include <filesystem>
#include <string>
#include <vector>

#include "core/parameters/input_error.h"
#include "scenarios/recordings/recording.h"

namespace remote_touch {

// As settings name it. Nothing is looked for, so that a sweep can tell the parts of all its cells at no cost.
struct RecordingPart {
  std::string path;
  int first_frame = 0;
  int last_frame = -1;  // -1: the last there is
  auto operator<=>(const RecordingPart&) const = default;
};

// A recording that is not on this machine: figures that need it are reported as not run. A damaged one is an
// error.
class MissingRecording : public InputError {
 public:
  using InputError::InputError;
};

// The folder below which relative paths are looked for that are not here; empty, as at first: none. It is
// that of the whole program, and set before anything is looked for: the command line takes REMOTE_TOUCH_DATA.
void set_data_folder(const std::string& folder);

// Where a recording is looked for: the path itself, then below the data folder. Throws MissingRecording when
// it is in neither place.
std::string find_recording(const std::string& path);

// Those places in the words of the command line: "here or below REMOTE_TOUCH_DATA = /data".
std::string recording_places();

// The frames of the part, first to last. Throws InputError when the recording has fewer.
struct FrameRange {
  int first = 0, last = 0;
};
FrameRange frames_of(const RecordingPart& part, const RecordingIndex& recording);

// The files from which the part's frames are made, each once, by name: a single PNG or mesh itself; the depth
// images or PCD files, the colour images that are registered to them, and camera.json, depth.txt and rgb.txt
// as far as they are used. Throws InputError when the recording is not there, its lists or camera.json cannot
// be used, or it has fewer frames; images and PCD files are not opened.
struct InputFile {
  std::string name;            // from the recording's folder, or from the one that holds a single PCD file
  std::filesystem::path file;  // to be opened
};
std::vector<InputFile> files_of(const RecordingPart& part);

}  // namespace remote_touch
