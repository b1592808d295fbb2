#include "runners/cli/replaced_settings.h"

#include <cstdio>

#include "core/parameters/input_error.h"
#include "runners/provenance/provenance.h"
#include "runners/settings/changed_settings.h"

namespace remote_touch {

void print_replaced(const std::vector<std::string>& overrides) {
  for (const std::string& line : replaced_settings(overrides))
    std::fprintf(stderr, "%s: %s\n", program_identity().name.c_str(), printable(line).c_str());
}

}  // namespace remote_touch
