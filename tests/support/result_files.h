// Shared by the tests of result files: a trace and a provenance that are hard to store, and queries of files
// that were read back.
#pragma once

#include <string>

#include "analysis/storage/result_file.h"
#include "analysis/trace/trace.h"

namespace remote_touch {

extern const TextAttributes kProvenance;

// A trace of numbers that a careless writer would change.
Trace awkward_trace(int ticks);

// Compares also the sign of zero and of NaN. Names and units are not compared.
bool same_bits(const Column& a, const Column& b);

// Null if there is no such dataset.
const Column* find(const Hdf5Content& content, const std::string& path);

// Returns "no attribute ..." if there is none.
std::string attribute(const Hdf5Content& content, const std::string& wanted);

}  // namespace remote_touch
