// A file of text, such as JSON or a list, read whole.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace remote_touch {

inline constexpr std::size_t kMaxTextBytes = 16 << 20;

// Reads a file, a pipe or a device, up to kMaxTextBytes. Throws InputError, naming the file and what is
// expected there, if it cannot be read, is longer than that, or a signal interrupts the wait for data.
std::string read_text_file(const std::filesystem::path& file, const std::string& expected);

// Throws InputError if the path leads to something else than a file: a folder, a pipe or a device, also by a
// link. Every input of a run is read twice or more, for its digest and for its content. A pipe can be read
// only once and may never be written to, and a device may never end. A path that leads nowhere is accepted;
// the reader refuses it.
void require_file(const std::filesystem::path& file);
// The same, but accepts a folder.
void require_file_or_folder(const std::filesystem::path& path);

// The same as read_text_file(), but refuses what require_file() refuses.
std::string read_input_text(const std::filesystem::path& file, const std::string& expected);

// Returns the text without a byte order mark, which some editors write in front of UTF-8.
std::string_view without_byte_order_mark(std::string_view text);

}  // namespace remote_touch
