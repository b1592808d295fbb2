// Packs the answers of a child process about an HDF5 file into bytes, and unpacks them. For
// analysis/storage/hdf5_* only.
#pragma once

#include <string>

#include "analysis/storage/hdf5_source.h"

namespace remote_touch {

// Overview of a file, which the child returns in one answer.
struct Hdf5Summary {
  TextAttributes attributes;
  std::vector<std::string> datasets;
  std::vector<std::int64_t> offsets;  // one for each dataset; -1: not stored in one piece
};

std::string packed(const Hdf5Summary& summary);
std::string packed(const Column& column);

// Throw std::runtime_error for bytes that packed() cannot have returned. A result is therefore valid,
// whatever happened to the child.
Hdf5Summary unpacked_summary(const std::string& bytes);
Column unpacked_column(const std::string& bytes);

}  // namespace remote_touch
