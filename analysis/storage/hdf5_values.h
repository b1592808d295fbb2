// Values of an HDF5 file, and the names of its dimensions and enumerations. For analysis/storage/hdf5_* only.
#pragma once

#include <string>
#include <vector>

#include "analysis/storage/hdf5_handle.h"
#include "analysis/trace/column.h"

namespace remote_touch {

// Values of attributes and datasets of an HDF5 file that any program may have written: kinds and sizes are
// checked before memory is allocated. For analysis/storage/hdf5_* only.

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
// enumeration without a name. For analysis/storage/hdf5_* only.

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
