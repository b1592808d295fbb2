// LZF decompression: the format of the blocks in binary_compressed PCD files.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace remote_touch {

// Maximum number of raw bytes for one byte of a block: the longest back reference makes 264 bytes out of 3.
constexpr std::size_t kLzfMaxExpansion = 88;

// Expands a block to exactly raw_size bytes. Throws InputError about file if the block is cut short, refers
// to bytes before its start, or expands to another number of bytes; nothing outside the block or the result
// is accessed. The result is allocated at once: a caller whose raw_size comes from a file must check it
// first.
std::vector<char> lzf_expand(const std::string& file, std::string_view block, std::size_t raw_size);

}  // namespace remote_touch
