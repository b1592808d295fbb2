#include "analysis/comparison/column_comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace remote_touch {

namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

std::string extent(const Column& column) {
  return std::to_string(column.length()) + " rows of " + std::to_string(column.width);
}

// Returns in words the first mismatch of the two columns; empty if there is none.
std::string mismatch(const Column& a, const Column& b) {
  if (a.values.index() != b.values.index()) return "different type of values";
  if (a.width != b.width || a.length() != b.length()) return extent(a) + " against " + extent(b);
  if (a.units != b.units) return "units " + a.units + " against " + b.units;
  if (a.value_names != b.value_names) return "different names of the values";
  return {};
}

double deviation(double a, double b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
  const double difference = b - a;
  return std::isfinite(difference) ? difference : kNotANumber;
}

// Length of a row of differences or values; 0 only if all are 0. It is computed in units of the largest one
// if the squares would over- or underflow.
template <class Component>
double length(std::size_t width, Component&& component) {
  if (width == 1) return std::abs(component(0));
  double squares = 0;
  for (std::size_t k = 0; k < width; ++k) squares += component(k) * component(k);
  if ((squares > 1e-280 && squares < 1e280) || std::isnan(squares)) return std::sqrt(squares);
  double max = 0;
  for (std::size_t k = 0; k < width; ++k) max = std::max(max, std::abs(component(k)));
  if (max == 0 || std::isinf(max)) return max;
  squares = 0;
  for (std::size_t k = 0; k < width; ++k) squares += (component(k) / max) * (component(k) / max);
  return max * std::sqrt(squares);
}

template <class Number>
double row_deviation(const Number* a, const Number* b, std::size_t width) {
  if (std::equal(a, a + width, b)) return 0;
  return length(width, [&](std::size_t k) { return deviation(a[k], b[k]); });
}

// False for names, texts and hashes, which are only equal or not.
bool has_deviations(const Column& column) {
  return std::holds_alternative<std::vector<double>>(column.values) ||
         (std::holds_alternative<std::vector<std::int32_t>>(column.values) && column.value_names.empty());
}

// Calls visit(row, deviation) for every row that both columns have.
template <class Visit>
void for_rows(const Column& baseline, const Column& candidate, Visit&& visit) {
  if (baseline.values.index() != candidate.values.index() || baseline.width != candidate.width) return;
  const std::size_t rows = std::min(baseline.length(), candidate.length());
  const auto width = static_cast<std::size_t>(baseline.width);
  std::visit(
      [&](const auto& a) {
        using Numbers = std::decay_t<decltype(a)>;
        const auto& b = std::get<Numbers>(candidate.values);
        for (std::size_t i = 0; i < rows; ++i) {
          const auto *x = &a[i * width], *y = &b[i * width];
          if constexpr (std::is_arithmetic_v<typename Numbers::value_type>)
            visit(i, has_deviations(baseline)      ? row_deviation(x, y, width)
                     : std::equal(x, x + width, y) ? 0
                                                   : 1);
          else
            visit(i, std::equal(x, x + width, y) ? 0 : 1);
        }
      },
      baseline.values);
}

// Length of a row of the baseline; 0 for texts and hashes, which have no length.
double length_of(const Column& column, std::size_t row) {
  const auto* numbers = std::get_if<std::vector<double>>(&column.values);
  const auto* integers = std::get_if<std::vector<std::int32_t>>(&column.values);
  const auto width = static_cast<std::size_t>(column.width);
  return length(width, [&](std::size_t k) -> double {
    return numbers ? (*numbers)[row * width + k] : integers ? (*integers)[row * width + k] : 0;
  });
}

// The relative tolerance allows nothing if the baseline's row has no finite length.
double allowed(const Column& baseline, std::size_t row, const Tolerance& tolerance) {
  if (tolerance.relative == 0) return tolerance.absolute;
  const double size = length_of(baseline, row);
  return tolerance.absolute + (std::isfinite(size) ? tolerance.relative * size : 0);
}

}  // namespace

ColumnComparison compare_columns(const Column& baseline, const Column& candidate,
                                 const Tolerance& tolerance) {
  ColumnComparison result{baseline.name, baseline.units, tolerance, mismatch(baseline, candidate)};
  result.baseline_rows = baseline.length(), result.candidate_rows = candidate.length();
  const bool measured = has_deviations(baseline);
  double squares = 0;
  std::size_t finite = 0;
  for_rows(baseline, candidate, [&](std::size_t row, double deviation) {
    ++result.rows;
    finite += std::isfinite(deviation) ? 1 : 0;
    if (deviation == 0) return;
    if (!result.first_difference) result.first_difference = row;
    const bool inside = measured && deviation <= allowed(baseline, row, tolerance);
    if (std::isnan(deviation))
      ++result.not_numbers;
    else if (measured)
      result.max = std::max(result.max, deviation), squares += deviation * deviation;
    if (inside) return;
    ++result.outside;
    if (!result.first_outside) result.first_outside = row;
  });
  if (finite > 0) result.rms = std::sqrt(squares / static_cast<double>(finite));
  return result;
}

std::vector<double> deviations(const Column& baseline, const Column& candidate) {
  std::vector<double> all;
  for_rows(baseline, candidate, [&](std::size_t, double deviation) { all.push_back(deviation); });
  return all;
}

}  // namespace remote_touch
