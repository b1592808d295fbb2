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

// Returns the text without a byte order mark, which some editors write in front of UTF-8.
std::string_view without_byte_order_mark(std::string_view text);

}  // namespace remote_touch
