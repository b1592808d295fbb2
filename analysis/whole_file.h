// Files that appear complete or not at all.
#pragma once

#include <cstddef>
#include <filesystem>

namespace remote_touch {

// Writes to a temporary name in the same folder, flushes to the disk and renames over the target. On failure
// (missing folder, no permission, full disk) throws InputError naming the target, and leaves neither a part
// nor a temporary.
void write_whole_file(const std::filesystem::path& target, const void* data, std::size_t size);

}  // namespace remote_touch
