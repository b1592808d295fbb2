// Files that appear complete or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace remote_touch {

// Writes to a temporary name in the same folder, flushes to the disk and renames over the target, or over
// what it links to. On failure (missing folder, no permission, full disk, a pipe, a socket or a device)
// throws InputError naming the target, and leaves neither a partial nor a temporary file. The new file has
// the permissions of the file that it replaces. The only device that can be written is /dev/null. A file that
// appeared at the target meanwhile is kept if replacement_rule.h requires it.
void write_file_atomically(const std::filesystem::path& target, const void* data, std::size_t size);

struct NewFile {
  std::filesystem::path target;  // a regular file, or absent
  std::string content;
};
// Replaces files that belong together. All are written beside their targets and flushed to the disk first;
// then they are renamed, with nothing else to do in between. If one cannot be written or renamed, it throws
// InputError, which names that target, and all targets are as before. If an old file cannot be put back, it
// is kept beside its target, and the message names it. Only a program that is killed between two renames
// leaves the first files new and the others old.
void write_files_together(const std::vector<NewFile>& files);

// Throws the InputError of write_file_atomically() if the folder is missing or not writable, or if the target
// is not a file, before any work is done for the file. Never blocks.
void require_writable(const std::filesystem::path& target);

// Throws InputError, which names the target, if the target and the input are the same file.
void require_different_file(const std::filesystem::path& target, const std::filesystem::path& input);

// Returns the temporary name, in the target's folder, under which this process writes the target.
std::filesystem::path temporary_of(const std::filesystem::path& target);
// Flushes the temporary file to the disk and renames it over the target. Fails like write_file_atomically(),
// also if a file appeared meanwhile.
void move_into_place(const std::filesystem::path& temporary, const std::filesystem::path& target);

// Gives an open file the permissions of the file at the place, if there is one; its owner can always read and
// write it.
void keep_permissions(int descriptor, const std::filesystem::path& place);

// Flushes the folder of the target, so that the names of its files outlast a power cut, if the file system
// supports that.
void flush_folder(const std::filesystem::path& target);

// Returns the file to which a symbolic link leads, whether it exists or not, or any other name unchanged.
// Throws InputError for a ring of links.
std::filesystem::path resolved(const std::filesystem::path& target);

// Removes temporary files of the target that killed programs left. pre: no other process writes it now.
void remove_leftovers(const std::filesystem::path& target);

}  // namespace remote_touch
