// Parts of what `inspect` prints.
#pragma once

#include <string>

#include "analysis/storage/hdf5_file.h"

namespace remote_touch {

// Ends the line with the range and the mean of numbers, the counts of names, the number of texts that are not
// empty and the first of them, or the last of hashes.
void print_values(const Column& column);

// Prints the runs and the measures of a tally, and what each of its arrays is. content: that of the file.
void print_tally(const std::string& file, const Hdf5Content& content);

}  // namespace remote_touch
