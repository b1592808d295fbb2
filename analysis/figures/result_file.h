// The layout of this project's results in HDF5: traces and figures.
#pragma once

#include <filesystem>
#include <string>

#include "analysis/figures/figure.h"
#include "analysis/storage/hdf5_file.h"
#include "analysis/trace/column.h"

namespace remote_touch {

struct Trace;

// columns: of Trace::columns(). provenance: config, command, version and so on, as root attributes. Adds
// schema, digest and the names of the columns in order. step_duration_s: wall clock of each tick, stored
// outside the digest as /timing; empty: not stored. Returns the digest.
std::string write_trace(const std::filesystem::path& file, const std::vector<Column>& columns,
                        const TextAttributes& provenance, const std::vector<double>& step_duration_s);
std::string write_trace(const std::filesystem::path& file, const Trace& trace,
                        const TextAttributes& provenance, const std::vector<double>& step_duration_s);

std::string write_figure(const std::filesystem::path& file, const Figure& figure,
                         const TextAttributes& provenance);

}  // namespace remote_touch
