// The layout of this project's results in HDF5: traces and figures.
#pragma once

#include <filesystem>
#include <string>

#include "analysis/figures/figure.h"
#include "analysis/storage/hdf5_file.h"
#include "analysis/trace/column.h"

namespace remote_touch {

struct Trace;

// Writes the columns, those of Trace::columns(), and returns their digest. provenance: config, command,
// version and so on, stored as root attributes. It adds the attributes schema, digest, default and columns
// (their names in the order of the digest). step_duration_s: wall clock time of each tick, stored outside the
// digest as /timing; empty: not stored.
std::string write_trace(const std::filesystem::path& file, const std::vector<Column>& columns,
                        const TextAttributes& provenance, const std::vector<double>& step_duration_s);
std::string write_trace(const std::filesystem::path& file, const Trace& trace,
                        const TextAttributes& provenance, const std::vector<double>& step_duration_s);

std::string write_figure(const std::filesystem::path& file, const Figure& figure,
                         const TextAttributes& provenance);

}  // namespace remote_touch
