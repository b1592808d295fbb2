// What a child process answers about an HDF5 file, as bytes and back. For analysis/storage/hdf5_* only.
#pragma once

#include <string>

#include "analysis/storage/hdf5_source.h"

namespace remote_touch {

// What of a file is asked for at once.
struct Hdf5Summary {
  TextAttributes attributes;
  std::vector<std::string> datasets;
  std::vector<std::int64_t> offsets;  // of each dataset; -1: not stored in one piece
};

std::string packed(const Hdf5Summary& summary);
std::string packed(const Column& column);

// Throw std::runtime_error for bytes that packed() does not give: whatever happened to the child, what comes
// back can be used.
Hdf5Summary unpacked_summary(const std::string& bytes);
Column unpacked_column(const std::string& bytes);

}  // namespace remote_touch
