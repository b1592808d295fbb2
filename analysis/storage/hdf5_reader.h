// Reads an HDF5 file one column, or some rows of one, at a time, because a file may be larger than memory
// allows.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "analysis/storage/hdf5_source.h"
#include "core/parameters/input_error.h"

namespace remote_touch {

// The file's name belongs to another file than the one that was opened, as when a sweep replaces its file at
// the end: values that were read from both do not fit together. The whole can be read again.
struct ReplacedFile : InputError {
  explicit ReplacedFile(const std::string& file);
};

// Every member throws InputError naming the file when it is damaged. A file with a valid seal is read in this
// process; one without, which another program wrote or which is not finished, in a child process with limits
// for each column: there the HDF5 library may crash or hang. Such a file may be replaced meanwhile: then
// members throw ReplacedFile.
class Hdf5Reader {
 public:
  // Throws InputError when the file is missing or not HDF5, when its seal is broken or a finished result of
  // this program has none, or when its layout is that of another version of this program. run: how the
  // child processes are run.
  explicit Hdf5Reader(const std::filesystem::path& file, const RunInChild& run = in_own_child);
  // The content of a sealed file of that name; throws InputError for another version of this program.
  Hdf5Reader(std::string file, std::shared_ptr<const Hdf5Source> content);

  const std::string& file() const { return file_; }
  // Throws InputError unless the file is of that kind, see schema_name(); made_by: the command that makes
  // one, for the message.
  void require_kind(const std::string& kind, const std::string& made_by) const;
  const TextAttributes& attributes() const { return attributes_; }  // text attributes of the root
  std::vector<std::string> datasets() const;                        // paths, sorted
  bool has(const std::string& dataset) const;
  // An array of more than two dimensions comes as one column.
  Column column(const std::string& dataset) const;
  // Rows first .. first + count - 1; pre: they are there.
  Column rows(const std::string& dataset, std::size_t first, std::size_t count) const;
  // The values of a column of that width, which are of type T.
  template <class T>
  std::vector<T> values(const std::string& dataset, int width = 1) const {
    Column read = column(dataset);
    auto* values = std::get_if<std::vector<T>>(&read.values);
    if (!values || read.width != width) damaged(dataset + " has values of another kind");
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
  std::shared_ptr<const HeldFile> held_;  // while its name is used
  std::shared_ptr<const Hdf5Source> content_;
  TextAttributes attributes_;
};

}  // namespace remote_touch
