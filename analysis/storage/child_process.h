// Runs work that may hang, crash or take all memory, such as a library that reads a file of unknown origin,
// in a separate process.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

namespace remote_touch {

struct ChildLimits {
  std::size_t memory_bytes;  // added to the memory that this process has
  unsigned processor_s;
};

// Limits for reading a file: 512 MiB plus memory_for_each_byte for each of its bytes; 1 s plus 1 s for each
// MiB.
ChildLimits limits_to_read(const std::filesystem::path& file, std::size_t memory_for_each_byte);

// Returns the result of `work`. Its changes to memory do not affect this process. Throws std::runtime_error
// with the message of the exception of `work`, or with the reason why the child process ended.
std::string in_child(const ChildLimits& limits, const std::function<std::string()>& work);

// A reader whose only input is a string of bytes, so that a process which was started earlier can run it too.
using ChildReader = std::string (*)(const std::string& question);
// Runs a reader in a child process. Returns and throws like in_child().
using RunInChild =
    std::function<std::string(const ChildLimits&, ChildReader reader, const std::string& question)>;
// Runs the reader in a child that begins for this question and ends with its answer.
std::string in_own_child(const ChildLimits& limits, ChildReader reader, const std::string& question);

// Prepares a child process that has just started. Signals then end it, whatever handlers the program has. The
// end of its parent and exceeding the limits end it too.
void become_limited_child(const ChildLimits& limits);

}  // namespace remote_touch
