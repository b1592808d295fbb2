// Independent pieces of work on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace remote_touch {

// Calls work(0) ... work(count - 1), each once, on any thread and in any order, and returns after all have
// ended. If some threw, it then throws the exception of the one with the lowest number.
using SideBySide = std::function<void(std::size_t count, const std::function<void(std::size_t)>& work)>;

// Uses as many threads as OpenMP does.
void side_by_side(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace remote_touch
