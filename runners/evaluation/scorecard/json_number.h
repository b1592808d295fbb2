// Numbers for a JSON file.
#pragma once

#include "scenarios/text_files/text_file.h"

namespace remote_touch {

// JSON has neither NaN nor infinity.
Json number_or_null(double value);

}  // namespace remote_touch
