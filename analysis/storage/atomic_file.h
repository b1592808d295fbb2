// Files that appear complete or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace remote_touch {

// Writes to a temporary name in the same folder, flushes to the disk and renames over the target, or over
// what it links to. On failure (missing folder, no permission, full disk, a pipe, a socket or a device)
// throws InputError naming the target, and leaves neither a partial nor a temporary file. Of devices
// /dev/null is written. A file that appeared meanwhile is kept where replacement_rule.h says so.
void write_file_atomically(const std::filesystem::path& target, const void* data, std::size_t size);

struct NewFile {
  std::filesystem::path target;  // a regular file, or absent
  std::string content;
};
// Replaces files that belong together. All are written beside their targets and flushed to the disk first;
// then they are renamed, with nothing else to do in between. When one cannot be written or renamed, throws
// InputError naming it, and all targets are as they were. Only a program that is killed between two renames
// leaves the first files new and the others old.
void write_files_together(const std::vector<NewFile>& files);

// Throws as write_file_atomically would for a folder that is missing or not writable, and for what is no
// file, before any work is done for the file. Waits for nobody.
void require_writable(const std::filesystem::path& target);

// Throws InputError, naming the target, when it is the file that is read.
void require_different_file(const std::filesystem::path& target, const std::filesystem::path& input);

// The temporary name in the target's folder under which this process writes it.
std::filesystem::path temporary_of(const std::filesystem::path& target);
// Flushes the temporary file to the disk and renames it over the target. Fails as write_file_atomically(),
// also where a file appeared meanwhile.
void move_into_place(const std::filesystem::path& temporary, const std::filesystem::path& target);

// Flushes the folder of the target, so that the names of its files outlast a power cut, if the file system
// supports that.
void flush_folder(const std::filesystem::path& target);

// The file that a symbolic link leads to, whether it exists or not; any other name unchanged. Throws
// InputError for a ring of links.
std::filesystem::path resolved(const std::filesystem::path& target);

// Removes temporary files of the target that killed programs left. pre: no other process writes it now.
void remove_leftovers(const std::filesystem::path& target);

}  // namespace remote_touch
