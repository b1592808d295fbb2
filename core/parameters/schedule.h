// A fraction over time: rows of time in seconds and fraction.
#pragma once

#include <string>
#include <vector>

namespace remote_touch {

// Returns the fraction at a time. It is linear between two rows and jumps where two rows have the same time.
// It is constant before the first row and after the last. It is 1 if there are no rows.
double scheduled(const std::vector<double>& rows, double time_s);

// Returns a message about the first row whose fraction is above 1 or whose time is before that of the
// previous row, such as "NAME: time ..."; empty if there is none. what: name of the fraction in that message.
std::string validate_schedule(const std::vector<double>& rows, const std::string& name,
                              const std::string& what);

}  // namespace remote_touch
