// Arrays for NumPy: one .npz archive.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "analysis/trace/trace.h"
#include "runners/presentation/export/exported_run.h"

namespace remote_touch {

// Returns an array in the file format of NumPy, .npy, version 1.0. Its shape is (n,) or (n, width), its type
// little-endian: <f8, <i4, <u8, or <U for texts.
std::string npy_array(const Column& column);
// One text, of shape ().
std::string npy_text(const std::string& text);

// An archive in the format ZIP, whose members are stored as they are. Passes the bytes of the archive to
// `write` as it grows. It stores no times, so that equal members give equal bytes.
class ZipArchive {
 public:
  explicit ZipArchive(std::function<void(const std::string& bytes)> write) : write_(std::move(write)) {}
  // Throws std::length_error beyond 4 GiB or 65534 members, the limits of a ZIP archive without extensions.
  // Its text says which: "would be larger than 4 GiB".
  void add(const std::string& name, const std::string& content);
  void finish();

  // Returns the bytes with which an archive begins that has this first member.
  static std::string opening(const std::string& name, const std::string& content);

 private:
  struct Member {
    std::string name;
    std::uint32_t crc, size, at;
  };
  std::function<void(const std::string&)> write_;
  std::vector<Member> members_;
  std::uint64_t size_ = 0;
};

// Writes a member for each column: COLUMN, or TABLE/COLUMN if there are several tables. Numbers are as they
// are stored, vectors have shape (n, 3), enumerations are numbers. Before them are `format`, and `about`, a
// text of JSON: `attributes` of the result, and for each member `unit`, `meaning` and `names` of the values
// of an enumeration. Throws InputError beyond 4 GiB or 65534 arrays.
void write_npz(const ExportJob& job);

}  // namespace remote_touch
