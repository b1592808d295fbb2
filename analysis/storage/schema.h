// Names of the layouts of this program's files. Each file has its name as a root attribute:
// "remote-touch-trace/3".
#pragma once

#include <string>

namespace remote_touch {

// One number for all layouts. It is raised if a name or the meaning of a value changes in any of them.
// Version 0.1 had 1, version 0.2 had 2.
inline constexpr int kSchemaVersion = 3;
// The oldest layout that is read. Layout 2 has other names of some settings, values and columns, which are
// translated: stored_configuration() and present_column().
inline constexpr int kOldestSchema = 2;
inline constexpr const char* kSchemaPrefix = "remote-touch-";

// kind: "trace", "figure", "sweep", "hashes" or "session".
inline std::string schema_name(const std::string& kind) {
  return kSchemaPrefix + kind + "/" + std::to_string(kSchemaVersion);
}

// True if the schema is that of a kind of file, in this layout or an earlier one that is read.
inline bool is_schema_of(const std::string& schema, const std::string& kind) {
  for (int version = kOldestSchema; version <= kSchemaVersion; ++version)
    if (schema == kSchemaPrefix + kind + "/" + std::to_string(version)) return true;
  return false;
}

// True for a layout of this program that is read but no longer written.
inline bool is_earlier_schema(const std::string& schema) {
  return schema.starts_with(kSchemaPrefix) &&
         schema.ends_with(std::string(1, '/') + std::to_string(kOldestSchema));
}

// Returns the schema of the same kind of file in this layout.
inline std::string present_schema(const std::string& schema) {
  return schema.substr(0, schema.rfind('/') + 1) + std::to_string(kSchemaVersion);
}

}  // namespace remote_touch
