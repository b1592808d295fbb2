// Work that may hang, crash or take all memory, such as a library that reads a file of unknown origin, in a
// process of its own.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace remote_touch {

struct ChildLimits {
  std::size_t memory_bytes;  // above what this process has
  unsigned processor_s;
};

// What work returns; nothing that it changes is changed here. Throws std::runtime_error with the message of
// what work threw, or how it ended.
std::string in_child(const ChildLimits& limits, const std::function<std::string()>& work);

}  // namespace remote_touch
