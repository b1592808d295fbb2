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

// The same of read_sweep_outline().
StoredSweep read_stored_outline(const Hdf5Reader& file);
// The same, but a part remains a part.
StoredSweep read_stored_part(const std::filesystem::path& file);

}  // namespace remote_touch
