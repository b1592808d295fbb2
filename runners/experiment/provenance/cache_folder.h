// The folder of the cache.
#pragma once

#include <filesystem>

namespace remote_touch {

// Returns the folder REMOTE_TOUCH_CACHE; else remote-touch in XDG_CACHE_HOME, or in ~/.cache. The path is
// empty if there is none.
std::filesystem::path cache_folder();

}  // namespace remote_touch
