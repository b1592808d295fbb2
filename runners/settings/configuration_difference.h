// Where two resolved configurations differ.
#pragma once

#include <string>
#include <vector>

namespace remote_touch {

// One text for each place, "renderer.r3_m 0.0075 against 0.007575"; empty when they are the same but for
// their titles. first and second are JSON texts. Throws InputError for a text that is none.
std::vector<std::string> configuration_differences(const std::string& first, const std::string& second);

}  // namespace remote_touch
