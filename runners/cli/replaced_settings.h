// --set options that have no effect, or not all of it.
#pragma once

#include <string>
#include <vector>

namespace remote_touch {

// Prints a line on standard error for each --set that a later --set replaces (changed_settings.h): the result
// is that of the last one, and the user may have meant another parameter. Called when the command has done
// its work, so that an error stays one line.
void print_replaced(const std::vector<std::string>& overrides);

}  // namespace remote_touch
