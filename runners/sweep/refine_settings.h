// The section "refine" of a sweep.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/measures/measures.h"
#include "runners/experiment/settings/json_parameters.h"

namespace remote_touch {

struct RefineSettings {
  std::string measure = "popped_through";
  double threshold = 0.5;
  std::uint64_t budget = 10000;
  int max_replicates = 20;
  int levels = 0;
};

Parameters parameters(RefineSettings& refine);

// Reads the section of a sweep with these measures and replicates. Returns nothing if the sweep has no such
// section. Throws InputError.
std::optional<RefineSettings> read_refine(const Json& sweep, const std::vector<Measure>& measures,
                                          int replicates, const std::string& label);

}  // namespace remote_touch
