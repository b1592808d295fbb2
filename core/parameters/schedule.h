// A fraction over time: rows of time in seconds and fraction.
#pragma once

#include <string>
#include <vector>

namespace remote_touch {

// Linear between rows, a jump where two have the same time; constant before the first row and after the last;
// 1 without rows.
double scheduled(const std::vector<double>& rows, double time_s);

// Describes the first row with a fraction above 1 or a time before the row above, as "NAME: time ..."; empty:
// none. what: name of the fraction in that message.
std::string validate_schedule(const std::vector<double>& rows, const std::string& name,
                              const std::string& what);

}  // namespace remote_touch
