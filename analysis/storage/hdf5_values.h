// Values of attributes and datasets of an HDF5 file that any program may have written: kinds and sizes are
// checked before memory is allocated. For analysis/storage/hdf5_* only.
#pragma once

#include <string>

#include "analysis/storage/hdf5_handle.h"
#include "analysis/trace/column.h"

namespace remote_touch {

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

}  // namespace remote_touch
