// HDF5 files that grow while something is recorded.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_file.h"

namespace remote_touch {

// Appends rows to the datasets of a file. The file is written under a temporary name beside the target;
// finish() seals it and renames it to the target. Without finish() no file remains. If the program is killed,
// the temporary file remains until the next appender of the same target removes it. Not for use from several
// threads at once, nor while another thread uses HDF5. Every member throws InputError, which names the
// target, if the target cannot be written. A device cannot be a target, not even /dev/null.
class Hdf5Appender {
 public:
  enum class Number { f64, f32, i32, u64, u32, u16 };

  explicit Hdf5Appender(const std::filesystem::path& target);
  ~Hdf5Appender();
  Hdf5Appender(const Hdf5Appender&) = delete;
  Hdf5Appender& operator=(const Hdf5Appender&) = delete;

  void group(const std::string& path);
  struct Dataset {
    std::string path, units, long_name;
    Number number = Number::f64;
    std::vector<unsigned long long> row =
        {};  // extent of a row: {} one number, {3} a vector, {h, w} an image
    unsigned long long rows_a_chunk = 4096;
  };
  void dataset(const Dataset& made);
  // rows: count rows in the type of the dataset and the machine's byte order.
  void append(const std::string& path, const void* rows, std::size_t count);
  // Appends one row that deflated_row() returned. pre: the dataset has one row in each chunk.
  void append_deflated(const std::string& path, const std::string& row);
  void attributes(const std::string& object, const TextAttributes& list);
  void finish();

 private:
  struct Open {
    std::int64_t id;
    Dataset made;
    unsigned long long rows = 0;
  };
  template <class Call>
  void guarded(const Call& call);
  void begin();
  bool close();
  void remove_temporary();

  const Hdf5Work work_;
  const std::filesystem::path target_, temporary_;
  std::int64_t file_ = -1;
  bool finished_ = false;
  std::map<std::string, Open> open_;
};

// Returns the bytes of a row of `count` values as the file stores them: shuffled (the first bytes of all
// values, then the second bytes, ...) and deflated. It does not call the HDF5 library, so it may run while
// another thread uses HDF5.
std::string deflated_row(const void* values, std::size_t count, std::size_t value_size);

// True if `row` decompresses to exactly `size` bytes.
bool is_deflated_row(const std::string& row, std::size_t size);

}  // namespace remote_touch
