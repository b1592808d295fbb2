#include "runners/experiment/provenance/cache_folder.h"

#include <cstdlib>

namespace remote_touch {

namespace fs = std::filesystem;

// The environment is read here and not in runners/interfaces/cli. A cache is not an input, so no result
// depends on it, and every program that makes tools, also a test, must find the same one.
fs::path cache_folder() {
  const auto from = [](const char* variable) {
    const char* value = std::getenv(variable);
    return fs::path(value != nullptr ? value : "");
  };
  if (const fs::path own = from("REMOTE_TOUCH_CACHE"); !own.empty()) return own;
  if (const fs::path caches = from("XDG_CACHE_HOME"); !caches.empty()) return caches / "remote-touch";
  if (const fs::path home = from("HOME"); !home.empty()) return home / ".cache" / "remote-touch";
  return {};
}

}  // namespace remote_touch
