// The report of a comparison: as JSON, and as tables for people.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "runners/evaluation/regression/result_comparison.h"

namespace remote_touch {

// Comparisons in machine-readable form, JSON.

// The whole comparison, {"outcome", "verdict", "kind", "columns": [...], "divergence": {...}, ...}. Numbers
// that are not finite are null.
std::string comparison_json(const ResultComparison& comparison);
std::string comparison_json(const std::vector<ResultComparison>& comparisons);  // a list

// Writes a report; throws InputError when it cannot.
void write_report(const std::filesystem::path& file, const std::string& text);

// Prints a comparison for people, as tables, on standard output unless another stream is given.

void print_comparison(const ResultComparison& comparison, std::FILE* out = stdout);

// "same", "REGRESSED", "CHANGED", "COULD NOT COMPARE".
const char* word_for(Outcome outcome);

// "exact", or "1e-09 + 1e-06 relative".
std::string tolerance_text(const Tolerance& tolerance);

// The fewest digits that state the number exactly: "0.033", not "0.033000000000000002".
std::string shortest_text(double number);

}  // namespace remote_touch
