// Handles of the HDF5 library, values of an HDF5 file, and the names of its dimensions and enumerations. For
// analysis/storage/hdf5_* only.
#pragma once

#include <hdf5.h>
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "analysis/trace/columns.h"

namespace remote_touch {

// Throws the error of the call that the library refused: std::runtime_error with the error text of the
// system, if the library reports one; else std::bad_alloc, if it found no memory; else std::runtime_error.
[[noreturn]] void throw_refusal();

// Stops the library from printing errors, because they become exceptions. Every thread must call it before it
// uses the library.
void use_hdf5();

// Closes the object that it holds. A negative identifier means that a call of the library failed.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {
    if (id < 0) throw_refusal();
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }
  // Closes the object now. Throws if the library cannot, for example because it cannot write the last values.
  void finish() {
    const herr_t result = close_(std::exchange(id_, -1));
    if (result < 0) throw_refusal();
  }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

inline void check(herr_t result) {
  if (result < 0) throw_refusal();
}

// Property list for a new object. Time stamps are off, so that equal contents are equal bytes.
inline Handle creation_list(hid_t kind) {
  Handle list(H5Pcreate(kind), H5Pclose);
  check(H5Pset_obj_track_times(list, false));
  return list;
}

inline Handle space_of(const std::vector<hsize_t>& extent) {
  return Handle(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), H5Sclose);
}

inline Handle text_type(std::size_t length) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  check(H5Tset_size(type, std::max<std::size_t>(1, length)));
  check(H5Tset_cset(type, H5T_CSET_UTF8));
  check(H5Tset_strpad(type, H5T_STR_NULLPAD));
  return type;
}

// Writes an attribute of an existing group or dataset.
inline void write_attribute(hid_t file, const std::string& object, const std::string& name, hid_t stored,
                            hid_t space, hid_t in_memory, const void* values) {
  const Handle made(H5Acreate_by_name(file, object.c_str(), name.c_str(), stored, space, H5P_DEFAULT,
                                      H5P_DEFAULT, H5P_DEFAULT),
                    H5Aclose);
  check(H5Awrite(made, in_memory, values));
}

inline void write_text(hid_t file, const std::string& object, const std::string& name,
                       const std::string& value) {
  const Handle type = text_type(value.size());
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  write_attribute(file, object, name, type, space, type, value.empty() ? "\0" : value.data());
}

// Values of attributes and datasets of an HDF5 file that any program may have written: kinds and sizes are
// checked before memory is allocated.

// Returns the text of an attribute; several texts are joined by ", ". Empty if it is not a text, or has
// variable length.
std::string read_text(hid_t attribute);
// Empty if the object has no such attribute.
std::string text_attribute(hid_t object, const char* name);

struct RowRange {
  hsize_t first, count;
};

// Reads all rows of a dataset if `rows` is null, else those rows. Throws std::exception with what is wrong
// with it.
Column read_dataset(hid_t data, const std::string& name, const RowRange* rows);

// Names that other programs need in a file: one for every dimension and every enumeration. The netCDF library
// and h5netcdf cannot open a dataset of which only some dimensions have names, and netCDF cannot open an
// enumeration without a name.

// Adds a dimension that has a name and no values, as netCDF writes it, unless it is there already.
void add_dimension(hid_t file, const std::string& path, hsize_t size);
// Adds the names of the components of vectors (xyz) or of quaternions (wxyz) as a dimension of that group,
// unless it is there already. Returns its path. pre: width is 3 or 4.
std::string component_labels(hid_t file, const std::string& group, int width);
void attach_dimension(hid_t file, const std::string& dataset, const std::string& dimension, unsigned place);
// True if a dataset only names a dimension, like those that the functions above add. It is not a column.
bool only_names_a_dimension(hid_t file, const std::string& dataset);

// Returns the enumeration of a column's values, stored in the root as COLUMN_values, or as COLUMN_values2 and
// so on if that one has other values. Columns of the same name with the same value names share it.
Handle named_enumeration(hid_t file, const std::string& column, const std::vector<std::string>& value_names);
// Writes the same names, by the CF convention of netCDF, for readers that read an enumeration as numbers.
void write_flags(hid_t file, const std::string& dataset, const std::vector<std::string>& value_names);

// Type of one byte of a text in a dataset. The dataset's attribute kEncoding states the encoding, because
// Octave opens no file with a dataset that HDF5 itself calls UTF-8.
Handle character_type();

// Attribute of a dataset of texts, whose last dimension is that of the characters of a text. The name is
// netCDF's.
inline constexpr const char* kEncoding = "_Encoding";

}  // namespace remote_touch
