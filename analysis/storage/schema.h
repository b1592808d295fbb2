// The layouts of this program's files by name: "remote-touch-trace/2", a root attribute of each.
#pragma once

#include <string>

namespace remote_touch {

// One number for all layouts: raised when a name or the meaning of a value changes in any. Version 0.1 had 1.
inline constexpr int kSchemaVersion = 2;
inline constexpr const char* kSchemaPrefix = "remote-touch-";

// kind: "trace", "figure", "sweep", "hashes" or "session".
inline std::string schema_name(const std::string& kind) {
  return kSchemaPrefix + kind + "/" + std::to_string(kSchemaVersion);
}

}  // namespace remote_touch
