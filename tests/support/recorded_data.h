// The folder of real recordings and meshes, for tests that read them.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace remote_touch {

// Returns the folder REMOTE_TOUCH_DATA if it is set, else ../shared/data beside the project.
inline std::filesystem::path data_root() {
  if (const char* named = std::getenv("REMOTE_TOUCH_DATA")) return named;
  return std::filesystem::path(REMOTE_TOUCH_SOURCE_DIR).parent_path() / "shared/data";
}

}  // namespace remote_touch
