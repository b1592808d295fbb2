// Numbers that the second implementation (tests/second_implementation) computes from the equations, for
// claims to compare with. Its tables are data/second_implementation/*.json, so no number is copied by hand.
#pragma once

#include <string>
#include <vector>

namespace remote_touch {

// Returns a number by the name of the table and its path in it: ("chapter_5", "/crossing/max_force_N").
double second_number(const std::string& table, const std::string& place);
// Returns the same column of every row of a list.
std::vector<double> second_column(const std::string& table, const std::string& list,
                                  const std::string& column);

}  // namespace remote_touch
