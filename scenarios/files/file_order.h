// The order of the files of a folder.
#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace remote_touch {

// Tests of file names that decide which files of a folder belong to a recording.

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

// Sorts files by name. Numbers in names are compared as numbers: frame_9, frame_10, frame_0100. The digits
// after the point of a clock time (nine digits or more) are decimals: 1305031102.16 is before 1305031102.5.
// If the numbers are equal, as 01 and 1, the texts are compared.
void sort_by_name(std::vector<std::filesystem::path>& files);

// Returns all numbers in a name, without leading zeros: 2 and 7 for img_2_0007, 0 for 000.
std::vector<std::string> numbers_in_name(const std::string& name);

// Returns the index of each name by the numbers in it, without its ending. Names without a number count as
// their indices. Throws InputError about the subject if two names have the same numbers.
std::map<std::vector<std::string>, std::size_t> frames_by_numbers(const std::filesystem::path& subject,
                                                                  const std::vector<std::string>& names);

// Returns one line about files whose names differ in nothing but leading zeros and the ending, such as
// frame_1.pcd and frame_01.pcd: probably one of them is a copy. Empty if there are none. Pre: the files are
// in the order of sort_by_name().
std::string equal_numbers(const std::vector<std::filesystem::path>& files);

}  // namespace remote_touch
