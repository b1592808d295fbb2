// Reads an HDF5 file one column, or some rows of one, at a time, because a file may be larger than the
// memory. The HDF5 library answers queries of the content in this process or in a child.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "analysis/storage/other_processes.h"
#include "core/parameters/parameter.h"

namespace remote_touch {

// Queries of the content. Members throw std::exception with what is wrong with the file, without its name.
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

// Thrown if the file's name now belongs to another file than the one that was opened, for example because a
// sweep replaced its file at the end. Values that were read from both do not fit together. The new file can
// be read from its beginning.
struct ReplacedFile : InputError {
  explicit ReplacedFile(const std::string& file);
};

// Every member throws InputError, which names the file, if the file is damaged. A file with a valid seal is
// read in this process. A file without a seal was written by another program or is not finished, and the HDF5
// library may crash or hang on it. It is therefore read in child processes with limits, one for each query.
// If such a file is replaced meanwhile, members throw ReplacedFile.
class Hdf5Reader {
 public:
  // Throws InputError if the file is missing or not HDF5, if its seal is broken or a finished result of this
  // program has none, or if its layout is that of another version of this program. run: starts the child
  // processes.
  explicit Hdf5Reader(const std::filesystem::path& file, const RunInChild& run = in_own_child);
  // Reads `content`, that of a sealed file of that name. Throws InputError for another version of this
  // program.
  Hdf5Reader(std::string file, std::shared_ptr<const Hdf5Source> content);

  const std::string& file() const { return file_; }
  // Throws InputError unless the file is of that kind, see schema_name(); made_by: the command that makes
  // one, for the message.
  void require_kind(const std::string& kind, const std::string& made_by) const;
  const TextAttributes& attributes() const { return attributes_; }  // text attributes of the root
  std::vector<std::string> datasets() const;                        // paths, sorted
  bool has(const std::string& dataset) const;
  // An array of more than two dimensions is returned as one column of width 1.
  Column column(const std::string& dataset) const;
  // Rows first .. first + count - 1; pre: they exist.
  Column rows(const std::string& dataset, std::size_t first, std::size_t count) const;
  // Returns the values of a column. Throws InputError if they are not of type T or the width is another one.
  template <class T>
  std::vector<T> values(const std::string& dataset, int width = 1) const {
    Column read = column(dataset);
    auto* values = std::get_if<std::vector<T>>(&read.values);
    if (!values || read.width != width) damaged(dataset + " has values of another type or width");
    return std::move(*values);
  }
  std::int64_t offset(const std::string& dataset) const;  // byte offset of values; pre: stored in one piece

  [[noreturn]] void damaged(const std::string& how) const;

 private:
  class HeldFile;
  bool open(const RunInChild& run);
  bool is_replaced() const;
  void require_version() const;
  template <class Read>
  auto guarded(Read&& read) const;
  std::string file_;
  std::shared_ptr<const HeldFile> held_file_;  // set if queries open the file by its name
  std::shared_ptr<const Hdf5Source> content_;
  TextAttributes attributes_;
};

}  // namespace remote_touch
