// A shared library with renderers, see remote_touch_plugin.h.
#pragma once

#include <string>
#include <vector>

#include "runners/experiment/catalog/catalog.h"

namespace remote_touch {

// Loads the library and returns the entries of its renderers. It stays loaded until the program ends. Throws
// InputError for a file that is not there or is no such library, for another version of the interface, and
// for a renderer without what the interface requires.
std::vector<RendererEntry> load_plugin(const std::string& file);

}  // namespace remote_touch
