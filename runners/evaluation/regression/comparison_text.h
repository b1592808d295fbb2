// Prints a comparison for people, as tables, on standard output unless another stream is given.
#pragma once

#include <cstdio>
#include <string>

#include "runners/evaluation/regression/result_comparison.h"

namespace remote_touch {

void print_comparison(const ResultComparison& comparison, std::FILE* out = stdout);

// "same", "REGRESSED", "CHANGED", "COULD NOT COMPARE".
const char* word_for(Outcome outcome);

// "exact", or "1e-09 + 1e-06 relative".
std::string tolerance_text(const Tolerance& tolerance);

// The fewest digits that state the number exactly: "0.033", not "0.033000000000000002".
std::string shortest_text(double number);

}  // namespace remote_touch
