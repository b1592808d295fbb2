// The content of a result file as lines of text, so that the fuzzer changes numbers and names instead of
// HDF5's own structures:
//
//   schema remote-touch-hashes/3             an attribute of the root
//   /hashes/tick i32 1 0 10 20               a dataset: type (f64, i32, u64, text), width, values
//   /trace/state i32:free,contact 1 0 1 1    the same with names of its values
//
// Other lines are left out.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "analysis/storage/hdf5_reader.h"

namespace remote_touch::fuzz {

struct Content {
  TextAttributes attributes;
  std::map<std::string, Column> datasets;
};

Content content_of(std::string_view text);

// Returns the reader that a sealed file of that content would have.
Hdf5Reader reader_of(Content content);

// Returns the text up to a line "---", and the text after it. If there is no such line, it returns the text
// twice, as two results to compare.
std::pair<std::string_view, std::string_view> two_parts(std::string_view text);

}  // namespace remote_touch::fuzz
