// Sweeps in files, with the present names of settings.
#pragma once

#include <filesystem>

#include "analysis/sweeps/sweep_file.h"

namespace remote_touch {

// These read a sweep as read_sweep() does. In a sweep of schema /2 the configuration, and the names and
// values of its axes, have their present names, see stored_configuration(). Its schema is the present one,
// and it has the attribute translated_from.
StoredSweep read_stored_sweep(const Hdf5Reader& file);
StoredSweep read_stored_sweep(const std::filesystem::path& file);

}  // namespace remote_touch
