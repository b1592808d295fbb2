// The lists of a TUM RGB-D folder (depth.txt, rgb.txt), and which colour image belongs to which depth image.
#pragma once

#include <filesystem>
#include <vector>

#include "scenarios/recordings/recording.h"

namespace remote_touch {

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

}  // namespace remote_touch
