// Tests of file names that decide which files of a folder belong to a recording.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>

namespace remote_touch {

// Returns true if the file's extension is the ending (lower case, with its dot), in small or capital letters:
// .png and .PNG.
inline bool has_ending(const std::filesystem::path& file, std::string_view ending) {
  const std::string extension = file.extension().string();
  const auto same = [](char a, char b) {
    return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
  };
  return std::equal(extension.begin(), extension.end(), ending.begin(), ending.end(), same);
}

// Returns true if the name begins with a dot. Such files are not part of a recording: other systems write
// ._0001.png beside 0001.png.
inline bool is_hidden(const std::filesystem::path& file) {
  return file.filename().string().starts_with('.');
}

}  // namespace remote_touch
