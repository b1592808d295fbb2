// Where the cache is.
#pragma once

#include <filesystem>

namespace remote_touch {

// The folder REMOTE_TOUCH_CACHE; else remote-touch in XDG_CACHE_HOME, or in ~/.cache. Empty: there is none.
std::filesystem::path cache_folder();

}  // namespace remote_touch
