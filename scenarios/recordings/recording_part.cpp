#include "scenarios/recordings/recording_part.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>

#include "scenarios/meshes/recorded_truth.h"
#include "scenarios/recordings/bags/bag_file.h"
#include "scenarios/recordings/camera_path.h"
#include "scenarios/text_files/file_ending.h"
#include "scenarios/text_files/refuse.h"
#include "scenarios/text_files/text_file.h"

namespace remote_touch {

namespace fs = std::filesystem;

namespace {

std::string data_folder;

// The largest sizes of files that are read whole. Without a limit here the digest of a larger file is
// computed first, which can take minutes.
void require_readable_size(const fs::path& file) {
  constexpr std::uintmax_t kMaxMeshBytes = std::uintmax_t{2} << 30;  // 5 million triangles as text
  std::error_code unreachable;
  const std::uintmax_t size = fs::file_size(file, unreachable);
  if (unreachable) return;  // the reader refuses it
  for (const char* ending : {".obj", ".ply", ".stl"})
    if (has_ending(file, ending) && size > kMaxMeshBytes)
      refuse(file.string(), "is larger than 2 GiB: expected a mesh of at most 5 million triangles");
  for (const char* ending : {".csv", ".traj", ".txt", ".tum"})
    if (has_ending(file, ending) && size > kMaxTextBytes)
      refuse(file.string(), "is longer than ", kMaxTextBytes >> 20, " MiB: expected a shorter text");
}

// True for images, meshes, paths of poses, measured contacts and live sessions. A recording of frames is not
// made from such files.
bool is_single_file(const fs::path& file) {
  constexpr std::array kEndings = {".png", ".obj", ".ply",  ".stl", ".h5",
                                   ".oni", ".csv", ".traj", ".txt", ".tum"};
  return std::any_of(kEndings.begin(), kEndings.end(),
                     [&](const char* ending) { return has_ending(file, ending); });
}

// Returns all files of a bag, regardless of the topic and the frames.
std::vector<InputFile> bag_files(const fs::path& bag) {
  std::vector<InputFile> list;
  for (const fs::path& file : files_of_bag(bag)) list.push_back({file.filename().generic_string(), file});
  std::sort(list.begin(), list.end(), [](const InputFile& a, const InputFile& b) { return a.name < b.name; });
  return list;
}

}  // namespace

void set_data_folder(const std::string& folder) {
  data_folder = folder;
}

std::string recording_places() {
  return "here or below REMOTE_TOUCH_DATA" + (data_folder.empty() ? " (not set)" : " = " + data_folder);
}

std::string find_recording(const std::string& path) {
  const fs::path below = fs::path(data_folder) / path;
  const bool may_be_below = !data_folder.empty() && fs::path(path).is_relative();
  for (const fs::path& found : {fs::path(path), may_be_below ? below : fs::path()}) {
    std::error_code unreachable;
    if (found.empty() || !fs::exists(found, unreachable)) continue;
    require_file_or_folder(found);
    return found.string();
  }
  throw MissingRecording(path,
                         "no such recording, image or mesh: expected a folder or file " + recording_places());
}

FrameRange frames_of(const RecordingPart& part, const RecordingIndex& recording) {
  const int available = static_cast<int>(recording.frames.size());
  const int last = part.last_frame < 0 ? available - 1 : part.last_frame;
  if (part.first_frame >= available || last >= available)
    refuse(part.path, "first_frame = ", part.first_frame, ", last_frame = ", part.last_frame,
           ": expected 0 to ", available - 1);
  return {part.first_frame, last};
}

namespace {

std::vector<InputFile> listed_files(const RecordingPart& part) {
  const fs::path found = find_recording(part.path);
  if (is_single_file(found)) return {{found.filename().generic_string(), found}};
  if (is_bag(found)) return bag_files(found);
  const RecordingIndex recording = index_recording(found);
  const FrameRange frames = frames_of(part, recording);
  // The folder is absolute, because a list may name files by absolute paths: their names become ../../...
  const fs::path place = fs::absolute(found);
  const fs::path folder = fs::is_directory(place) ? place : place.parent_path();
  std::map<std::string, fs::path> files;
  const auto add = [&](const fs::path& file) {
    files.emplace(fs::absolute(file).lexically_relative(folder).generic_string(), file);
  };
  for (const fs::path& text : recording.texts) add(text);
  for (int i = frames.first; i <= frames.last; ++i) {
    const RecordedFrame& frame = recording.frames[static_cast<std::size_t>(i)];
    add(frame.depth);
    if (!frame.colour.empty()) add(frame.colour);
  }
  if (const fs::path poses = (folder / part.camera_poses).lexically_normal(); !part.camera_poses.empty()) {
    if (!fs::is_directory(poses)) add(poses);
    for (const fs::path& file :
         fs::is_directory(poses) ? pose_files(poses, recording) : std::vector<fs::path>())
      if (!file.empty()) add(file);
  }
  if (const std::optional<TruthFolder> truth = part.with_truth ? find_truth(folder) : std::nullopt)
    for (const fs::path& file : files_of(*truth)) add(file);
  std::vector<InputFile> list;
  for (const auto& [name, file] : files) list.push_back({name, file});
  return list;
}

}  // namespace

std::vector<InputFile> files_of(const RecordingPart& part) {
  std::vector<InputFile> files = listed_files(part);
  for (const InputFile& input : files) require_file(input.file), require_readable_size(input.file);
  return files;
}

}  // namespace remote_touch
