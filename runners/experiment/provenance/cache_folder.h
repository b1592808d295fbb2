// The folder of the cache.
#pragma once

#include <filesystem>

namespace remote_touch {

// Returns the folder that the environment variable REMOTE_TOUCH_CACHE names. If it is not set, returns the
// folder remote-touch in XDG_CACHE_HOME, or in .cache of HOME. The path is empty if none of these variables
// is set.
std::filesystem::path cache_folder();

}  // namespace remote_touch
