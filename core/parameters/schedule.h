// Shares over time: rows of time in seconds and share.
#pragma once

#include <string>
#include <vector>

namespace remote_touch {

// Even change between rows, a jump where two have the same time, the first before all, the last after all;
// 1 without rows.
double scheduled(const std::vector<double>& rows, double time_s);

// "schedule: time ...": the first row with a share outside 0 to 1 or a time before the one above; empty:
// none. what: the share's name.
std::string validate_schedule(const std::vector<double>& rows, const std::string& name,
                              const std::string& what);

}  // namespace remote_touch
