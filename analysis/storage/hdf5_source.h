// Queries of the content of an HDF5 file, which the HDF5 library answers in this process or in a child.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "analysis/storage/other_processes.h"

namespace remote_touch {

// Members throw std::exception with what is wrong with the file, without its name.
class Hdf5Source {
 public:
  virtual ~Hdf5Source() = default;
  virtual TextAttributes attributes() const = 0;          // text attributes of the root
  virtual std::vector<std::string> datasets() const = 0;  // paths of columns, sorted
  virtual Column column(const std::string& dataset) const = 0;
  // Rows first .. first + count - 1.
  virtual Column rows(const std::string& dataset, std::size_t first, std::size_t count) const = 0;
  // Byte offset of its values; throws if they are not stored in one piece.
  virtual std::int64_t offset(const std::string& dataset) const = 0;
};

// Opens a file in this process. pre: the file is as it was written, because the library crashes, hangs or
// allocates all memory on some damaged files.
std::unique_ptr<Hdf5Source> open_hdf5(const std::filesystem::path& file);

// Opens the bytes of such a file.
std::unique_ptr<Hdf5Source> open_hdf5_image(std::string_view bytes);

// A child process with limits answers each query. Only that process calls the library.
std::unique_ptr<Hdf5Source> open_hdf5_in_child(const std::filesystem::path& file,
                                               const RunInChild& run = in_own_child);

// Packs the answers of a child process about an HDF5 file into bytes, and unpacks them. For
// analysis/storage/hdf5_* only.

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
