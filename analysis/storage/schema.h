// Names of the layouts of this program's files. Each file has its name as a root attribute:
// "remote-touch-trace/2".
#pragma once

#include <string>

namespace remote_touch {

// One number for all layouts. It is raised if a name or the meaning of a value changes in any of them.
// Version 0.1 had 1.
inline constexpr int kSchemaVersion = 2;
inline constexpr const char* kSchemaPrefix = "remote-touch-";

// kind: "trace", "figure", "sweep", "hashes" or "session".
inline std::string schema_name(const std::string& kind) {
  return kSchemaPrefix + kind + "/" + std::to_string(kSchemaVersion);
}

}  // namespace remote_touch
