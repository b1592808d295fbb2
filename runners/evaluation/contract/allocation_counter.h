// Counts what the whole program allocates, so that a haptic tick can be shown to allocate nothing.
#pragma once

#include <cstddef>

namespace remote_touch {

std::size_t allocation_count();  // since the start of the program

}  // namespace remote_touch
