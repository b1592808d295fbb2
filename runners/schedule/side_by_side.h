// Independent pieces of work on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace remote_touch {

// Calls work(0) ... work(count - 1), each once, on any thread and in any order, and returns after all have
// ended; then throws what the first of them, in their order, threw.
using SideBySide = std::function<void(std::size_t count, const std::function<void(std::size_t)>& work)>;

// By as many threads as OpenMP gives.
void side_by_side(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace remote_touch
