// Text with numbers in it, by a format of printf().
#pragma once

#include <string>

namespace remote_touch {

// Returns what std::printf() would print.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...);

}  // namespace remote_touch
