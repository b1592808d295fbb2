// Sweeps in files, with the present names of settings.
#pragma once

#include <filesystem>

#include "analysis/sweeps/sweep_file.h"

namespace remote_touch {

// These read a sweep as read_sweep() does, and whole: the runs of other shards are `elsewhere`. In a sweep of
// schema /2 the configuration, and the names and values of its axes, have their present names, see
// stored_configuration(). Its schema is the present one, and it has the attribute translated_from.
StoredSweep read_stored_sweep(const Hdf5Reader& file);
StoredSweep read_stored_sweep(const std::filesystem::path& file);

// Reads an outline as read_sweep_outline() does, with present names.
StoredSweep read_stored_outline(const Hdf5Reader& file);
// Reads a sweep as read_stored_sweep() does, but a part stays a part.
StoredSweep read_stored_part(const std::filesystem::path& file);
// Reads a sweep as read_stored_part() does. For a tally, which keeps no runs, returns the outline.
StoredSweep read_runs_or_outline(const std::filesystem::path& file);

// Returns one line with the number of runs of a sweep in progress that have a wrong checksum; empty if there
// are none.
std::string damage_text(const StoredSweep& stored);

}  // namespace remote_touch
