// Runs work that may hang, crash or take all memory, such as a library that reads a file of unknown origin,
// in a separate process.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

namespace remote_touch {

struct ChildLimits {
  std::size_t memory_bytes;  // in addition to what this process has
  unsigned processor_s;
};

// What reading a file may take: 512 MiB and so many bytes for each of its own; 1 s and 1 s for each MiB.
ChildLimits limits_to_read(const std::filesystem::path& file, std::size_t memory_for_each_byte);

// Returns what work returns; its changes to memory do not reach this process. Throws std::runtime_error with
// the message of the exception of work, or with how the process ended.
std::string in_child(const ChildLimits& limits, const std::function<std::string()>& work);

// A reader that gets all it needs as bytes, so that also a process that began earlier can run it.
using ChildReader = std::string (*)(const std::string& question);
// Runs a reader in a child process; returns and throws as in_child does.
using RunInChild =
    std::function<std::string(const ChildLimits&, ChildReader reader, const std::string& question)>;
// In a child that begins for this question and ends with its answer.
std::string in_own_child(const ChildLimits& limits, ChildReader reader, const std::string& question);

// For a process that has just begun as a child: from now on signals end it, whatever the program does with
// them, and so do the end of its parent and what goes beyond the limits.
void become_limited_child(const ChildLimits& limits);

}  // namespace remote_touch
