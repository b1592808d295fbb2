// Differences between two resolved configurations.
#pragma once

#include <string>
#include <vector>

namespace remote_touch {

// Returns one text for each difference, such as "renderer.r3_m 0.0075 against 0.007575". Titles are not
// compared, nor are those of the experiments of two sweeps. A long value is shortened, but the first place
// at which it differs is shown. first and second are JSON texts. Throws InputError for a text that is not
// JSON.
std::vector<std::string> configuration_differences(const std::string& first, const std::string& second);

}  // namespace remote_touch
