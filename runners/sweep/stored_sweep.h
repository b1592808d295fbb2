// Sweeps in files, with the present names of settings.
#pragma once

#include <filesystem>
#include <string>

#include "analysis/sweeps/sweep_file.h"

namespace remote_touch {

// These read a sweep as read_sweep() does. In a sweep of schema /2 the configuration, and the names and
// values of its axes, have their present names, see stored_configuration(). Its schema is the present one,
// and it has the attribute translated_from.
StoredSweep read_stored_sweep(const Hdf5Reader& file);
StoredSweep read_stored_sweep(const std::filesystem::path& file);
// Returns the title in the configuration; an empty text if there is none.
std::string title_of(const StoredSweep& sweep);

}  // namespace remote_touch
