// The entries that this laboratory adds: a renderer, a scenario, a hand and a measure.
#pragma once

#include <runners/experiment/catalog/catalog.h>

namespace lab {

void add_entries(remote_touch::Catalog& catalog);

}  // namespace lab
