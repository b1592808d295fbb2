// Differences between two resolved configurations.
#pragma once

#include <string>
#include <vector>

namespace remote_touch {

// One text for each difference, "renderer.r3_m 0.0075 against 0.007575"; empty if only their titles differ,
// or those of the experiments of two sweeps. first and second are JSON texts. Throws InputError for a text
// that is not JSON.
std::vector<std::string> configuration_differences(const std::string& first, const std::string& second);

}  // namespace remote_touch
