#include "runners/experiment/provenance/input_hashes.h"

#include <algorithm>
#include <sstream>

#include "analysis/storage/digest.h"
#include "core/parameters/input_error.h"

namespace remote_touch {

void InputHashes::add(const std::vector<RecordingPart>& parts) {
  for (const RecordingPart& part : parts)
    if (parts_.count(part) == 0) read(part);
}

void InputHashes::read(const RecordingPart& part) {
  const std::vector<InputFile> files = files_of(part);  // throws before anything is stored
  auto& known = recordings_[part.path];
  for (const auto& [name, file] : files) {
    if (known.count(name) > 0) continue;
    const std::string sum = sha256_of_file(file);
    std::error_code failure;
    const std::uintmax_t size = std::filesystem::file_size(file, failure);
    if (failure) throw InputError(file.string(), "cannot be read (" + failure.message() + ")");
    known[name] = {sum, size};
  }
  parts_.insert(part);
}

std::string InputHashes::text() const {
  std::string text;
  for (const auto& [path, files] : recordings_) {
    std::vector<std::string> lines;
    std::uintmax_t bytes = 0;
    for (const auto& [name, file] : files) {
      const std::string plain = in_one_line(name);
      // sha256sum puts a backslash in front of a line whose file name it has changed.
      lines.push_back((plain == name ? "" : "\\") + file.sha256 + "  " + plain);
      bytes += file.size;
    }
    std::sort(lines.begin(), lines.end());
    Sha256 hash;
    for (const std::string& line : lines) hash.add((line + "\n").data(), line.size() + 1);
    if (!text.empty()) text += '\n';
    text += in_one_line(path) + ": " + std::to_string(files.size()) + " file(s), " + std::to_string(bytes) +
            " bytes, sha256 " + hash.hex();
  }
  return text;
}

std::string input_hashes(const std::vector<RecordingPart>& parts) {
  InputHashes hashes;
  hashes.add(parts);
  return hashes.text();
}

std::string in_one_line(const std::string& name) {
  std::string line;
  for (const char c : name) {
    if (c == '\\')
      line += "\\\\";
    else if (c == '\n')
      line += "\\n";
    else if (c == '\r')
      line += "\\r";
    else
      line += c;
  }
  return line;
}

namespace {

// Returns a map from the path in each line to the rest of the line.
std::map<std::string, std::string> by_path(const std::string& text) {
  std::map<std::string, std::string> lines;
  std::istringstream stream(text);
  stream.exceptions(std::ios::badbit);  // throws if memory runs out, which would look like the end
  for (std::string line; std::getline(stream, line);) {
    const std::size_t end = std::min(line.rfind(": "), line.size());
    lines[line.substr(0, end)] = line.substr(std::min(end + 2, line.size()));
  }
  return lines;
}

}  // namespace

std::vector<ChangedInput> changed_inputs(const std::string& before, const std::string& now) {
  const auto then = by_path(before), later = by_path(now);
  std::vector<ChangedInput> changed;
  for (const auto& [path, line] : then) {
    const auto same = later.find(path);
    if (same == later.end() || same->second != line)
      changed.push_back({path, line, same == later.end() ? "absent" : same->second});
  }
  for (const auto& [path, line] : later)
    if (then.count(path) == 0) changed.push_back({path, "absent", line});
  return changed;
}

void InputHashes::require_unchanged() const {
  remote_touch::require_unchanged({parts_.begin(), parts_.end()}, text());
}

void require_unchanged(const std::vector<RecordingPart>& parts, const std::string& before) {
  const std::vector<ChangedInput> changed = changed_inputs(before, input_hashes(parts));
  if (changed.empty()) return;
  const ChangedInput& first = changed.front();
  throw InputError(first.path, "changed while it was read (" + first.before + "; now " + first.now +
                                   "): expected files that no program writes during the run");
}

}  // namespace remote_touch
