// Comparisons in machine-readable form, JSON.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runners/evaluation/regression/result_comparison.h"

namespace remote_touch {

// The whole comparison, {"outcome", "verdict", "kind", "columns": [...], "divergence": {...}, ...}. Numbers
// that are not finite are null.
std::string comparison_json(const ResultComparison& comparison);
std::string comparison_json(const std::vector<ResultComparison>& comparisons);  // a list

// Writes a report; throws InputError when it cannot.
void write_report(const std::filesystem::path& file, const std::string& text);

}  // namespace remote_touch
