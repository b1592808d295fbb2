// Arrays in the file format of NumPy: .npy, version 1.0.
#pragma once

#include <string>

#include "analysis/trace/column.h"

namespace remote_touch {

// Returns an array of shape (n,) or (n, width), little-endian: <f8, <i4, <u8, or <U for texts.
std::string npy_array(const Column& column);
// One text, of shape ().
std::string npy_text(const std::string& text);

}  // namespace remote_touch
