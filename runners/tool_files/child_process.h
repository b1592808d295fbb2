// Runs work that may hang, crash or take all memory, such as a library that reads a file of unknown origin,
// in a separate process.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace remote_touch {

struct ChildLimits {
  std::size_t memory_bytes;  // in addition to what this process has
  unsigned processor_s;
};

// Returns what work returns; its changes to memory do not reach this process. Throws std::runtime_error with
// the message of the exception of work, or with how the process ended.
std::string in_child(const ChildLimits& limits, const std::function<std::string()>& work);

}  // namespace remote_touch
