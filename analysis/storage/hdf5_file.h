// HDF5 files, written whole or not at all, or while something is recorded. Only analysis/storage/hdf5_* call
// the HDF5 library.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "analysis/trace/columns.h"

namespace remote_touch {

// Names of the layouts of this program's files. Each file has its name as a root attribute:
// "remote-touch-trace/3".

// One number for all layouts. It is raised if a name or the meaning of a value changes in any of them.
// Version 0.1 had 1, version 0.2 had 2.
inline constexpr int kSchemaVersion = 3;
inline constexpr const char* kSchemaPrefix = "remote-touch-";

// kind: "trace", "figure", "sweep", "hashes" or "session".
inline std::string schema_name(const std::string& kind) {
  return kSchemaPrefix + kind + "/" + std::to_string(kSchemaVersion);
}

using TextAttributes = std::vector<std::pair<std::string, std::string>>;

// The HDF5 library may be at work as long as an object of this class exists. The library crashes in some
// calls that find no memory, and on some damaged files.
class Hdf5Work {
 public:
  Hdf5Work() { ++count_; }
  Hdf5Work(const Hdf5Work&) : Hdf5Work() {}
  Hdf5Work& operator=(const Hdf5Work&) = default;
  ~Hdf5Work() { --count_; }
  // is_on(): true if one exists. messages(): the file descriptor of the messages to the user, -1 if there are
  // none. A signal handler may call both.
  static bool is_on() { return count_ > 0; }
  static int messages() { return is_silent_ ? -1 : static_cast<int>(messages_); }
  // Sets that file descriptor, while the library's own messages are redirected.
  static void set_messages(int descriptor) { messages_ = descriptor; }
  // Switches the messages off in a child process that reads for its parent, because the parent reports how it
  // ended.
  static void silence() { is_silent_ = true; }

 private:
  static inline std::atomic<bool> is_silent_ = false;
  static inline std::atomic<int> messages_ = 2;
  static inline std::atomic<int> count_ = 0;
};

// Returns the attribute of that name; empty if there is none.
std::string attribute(const TextAttributes& attributes, const std::string& name);
// Returns the root attributes of a result that describe its provenance: all except those that the writer of a
// trace, sweep or figure adds itself.
TextAttributes provenance_of(const TextAttributes& attributes);

// Builds the file in memory, or on the disk beside its target; save() puts it in place. A full disk or a
// killed program therefore never leaves a partial file. Equal contents are equal bytes (no time stamps),
// wherever the file was built. Not for use from several threads at once.
class Hdf5Writer {
 public:
  // A finished file is sealed (digest.h). A file that will be written in place later cannot be sealed.
  enum class Finished { yes, no };
  explicit Hdf5Writer(Finished finished = Finished::yes);
  // Builds a finished file on the disk, because it may be larger than the memory. pre: no other process
  // writes the target, to which save() puts it. Throws InputError, which names the target, if it cannot be
  // written.
  explicit Hdf5Writer(const std::filesystem::path& target);
  ~Hdf5Writer();
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  void group(const std::string& path);  // pre: its parent exists
  // Attributes of a group or dataset that exists; "/" is the root.
  void attribute(const std::string& object, const std::string& name, const std::string& value);
  void attribute(const std::string& object, const std::string& name, const std::vector<double>& values);
  void attribute(const std::string& object, const std::string& name, std::int32_t value);
  void attributes(const std::string& object, const TextAttributes& list);
  // Writes the columns as datasets of a group, with units and long_name. The column named `rows` becomes the
  // dimension scale of the rows of all others, and columns of width 3 or 4 are vectors x, y, z or quaternions
  // w, x, y, z. If `rows` is empty, no column is the scale, and the components are not named.
  void columns(const std::string& group, const std::vector<Column>& columns, const std::string& rows);
  // Writes a column as an array over axes. The axes are names of datasets of the same group that scale() made
  // scales. The last axis runs fastest. in_place: stored in one piece, to be written in place later; compact:
  // in compressed chunks if it is long.
  enum class Storage { compact, in_place };
  void array(const std::string& group, const Column& column, const std::vector<std::string>& axes,
             Storage storage);
  // Returns `count` values from the index `first` on, in the type of the column.
  using Block = std::function<Values(std::size_t first, std::size_t count)>;
  // Writes a compact array, with the bytes of array(), whose values are asked for in increasing blocks.
  // column: has their type, but no values. longest_text: bytes of the longest text of a column of texts, at
  // least 1.
  void array_in_blocks(const std::string& group, const Column& column, const std::vector<std::string>& axes,
                       const Block& values, std::size_t longest_text = 1);
  // Makes a dataset the scale of its own dimension.
  void scale(const std::string& path);
  std::size_t size();  // size of the file so far, bytes
  // Throws InputError, which names the file, if it cannot be written.
  void save(const std::filesystem::path& target);

 private:
  using Extent = std::vector<unsigned long long>;
  void create();
  void dataset(const std::string& path, const Column& column, Extent extent, Storage storage);
  void block_dataset(const std::string& path, const Column& column, Extent extent, std::size_t longest_text,
                     const Block& values);
  void describe(const std::string& path, const Column& column, const Extent& extent);
  Extent extent_over(const std::string& group, const std::vector<std::string>& axes) const;
  void save_from_disk(const std::filesystem::path& target);
  std::string components(const std::string& group, int width, bool are_vectors);
  const Hdf5Work work_;
  bool sealed_;
  std::filesystem::path on_disk_;  // the file that is built; empty: it is built in memory
  std::int64_t file_ = -1;
};

struct Hdf5Content {
  TextAttributes attributes;                             // text attributes of the root
  std::vector<std::pair<std::string, Column>> datasets;  // path and values, in the order of the paths
};

// Reads every dataset; see hdf5_reader.h.
Hdf5Content read_hdf5(const std::filesystem::path& file);

// HDF5 files that grow while something is recorded.

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
