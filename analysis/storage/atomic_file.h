// Files that appear complete or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace remote_touch {

// Writes to a temporary name in the same folder, flushes to the disk and renames over the target, or over
// what it links to. On failure (missing folder, no permission, full disk, a pipe, a socket or a device)
// throws InputError naming the target, and leaves neither a partial nor a temporary file. The new file has
// the permissions of the file that it replaces. The only device that can be written is /dev/null. A file that
// appeared at the target meanwhile is kept if replacement_rule.h requires it.
void write_file_atomically(const std::filesystem::path& target, const void* data, std::size_t size);

// Throws the InputError of write_file_atomically() if the folder is missing or not writable, or if the target
// is not a file, before any work is done for the file. Never blocks.
void require_writable(const std::filesystem::path& target);

// Makes the folder and those above it. Throws InputError.
void make_folder(const std::filesystem::path& folder);

// Throws the InputError of a target that cannot be written. error: the errno of the call that failed.
[[noreturn]] void refuse_writing(const std::filesystem::path& target, int error, const std::string& expected);

// Throws InputError if the target is a device: a file that is renamed to it would replace it.
void require_no_device(const std::filesystem::path& target);

// Throws InputError, which names the target, if the target and the input are the same file.
void require_different_file(const std::filesystem::path& target, const std::filesystem::path& input);

// Returns the temporary name, in the target's folder, under which this process writes the target.
std::filesystem::path temporary_of(const std::filesystem::path& target);
// Flushes the temporary file to the disk and renames it over the target. Fails like write_file_atomically(),
// also if a file appeared meanwhile.
void move_into_place(const std::filesystem::path& temporary, const std::filesystem::path& target);

// Writes bytes to an open file. Returns 0, or the errno of the call that failed; `done` is the number of
// bytes that were written.
int write_all(int descriptor, const void* data, std::size_t size, std::size_t& done);

// Writes an open file to the disk, if it and its file system support that. Returns 0, or the errno.
int flush(int descriptor);

// True if that is the name of the open file.
bool is_name_of(const std::filesystem::path& name, int descriptor);

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
