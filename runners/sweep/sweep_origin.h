// Checks whether files belong to one sweep, made by one build.
#pragma once

#include <filesystem>
#include <string>

#include "analysis/storage/hdf5_file.h"

namespace remote_touch {

// Returns the attributes of the build that made a result. Runs of different builds are not put into one file.
TextAttributes build_of(const TextAttributes& attributes);

// Checks a file that a command continues. Throws InputError, which names the file, if it is of another sweep,
// shard or build, or was written with an earlier schema, so that it is not overwritten.
void require_same_sweep(const std::filesystem::path& file, const std::string& schema,
                        const TextAttributes& theirs, const TextAttributes& ours);

// Checks files that are merged, without their attributes `shard`. Throws InputError, which names both files,
// unless they are of one sweep, one build and the same recordings.
struct MergedFile {
  std::string file;
  const TextAttributes& attributes;
};
void require_same_origin(const MergedFile& part, const MergedFile& first);

}  // namespace remote_touch
