#include "analysis/column_comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace remote_touch {

namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

std::string extent(const Column& column) {
  return std::to_string(column.length()) + " rows of " + std::to_string(column.width);
}

// Why the columns are not two of the same kind; empty when they are.
std::string mismatch(const Column& a, const Column& b) {
  if (a.values.index() != b.values.index()) return "another kind of values";
  if (a.width != b.width || a.length() != b.length()) return extent(a) + " against " + extent(b);
  if (a.units != b.units) return "units " + a.units + " against " + b.units;
  if (a.value_names != b.value_names) return "other names of values";
  return {};
}

double deviation(double a, double b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
  const double difference = b - a;
  return std::isfinite(difference) ? difference : kNotANumber;
}

template <class Number>
double row_deviation(const Number* a, const Number* b, std::size_t width) {
  if (width == 1) return std::abs(deviation(*a, *b));
  double squares = 0;
  for (std::size_t k = 0; k < width; ++k) {
    const double d = deviation(a[k], b[k]);
    squares += d * d;
  }
  return std::sqrt(squares);
}

template <class Number>
double length(const Number* row, std::size_t width) {
  double squares = 0;
  for (std::size_t k = 0; k < width; ++k)
    squares += static_cast<double>(row[k]) * static_cast<double>(row[k]);
  return std::sqrt(squares);
}

// Names, texts and fingerprints have none: they are equal or not.
bool has_deviations(const Column& column) {
  return std::holds_alternative<std::vector<double>>(column.values) ||
         (std::holds_alternative<std::vector<std::int32_t>>(column.values) && column.value_names.empty());
}

// Hands (row, deviation, length of the baseline's row) of the rows that both have to visit.
template <class Visit>
void for_rows(const Column& baseline, const Column& candidate, Visit&& visit) {
  if (baseline.values.index() != candidate.values.index() || baseline.width != candidate.width) return;
  const std::size_t rows = std::min(baseline.length(), candidate.length());
  const auto width = static_cast<std::size_t>(baseline.width);
  const auto by_equality = [&](const auto& a, const auto& b) {
    for (std::size_t i = 0; i < rows; ++i)
      visit(i, std::equal(&a[i * width], &a[i * width] + width, &b[i * width]) ? 0.0 : 1.0, 0.0);
  };
  std::visit(
      [&](const auto& a) {
        using Numbers = std::decay_t<decltype(a)>;
        const auto& b = std::get<Numbers>(candidate.values);
        if (!has_deviations(baseline)) return by_equality(a, b);
        if constexpr (std::is_arithmetic_v<typename Numbers::value_type>)
          for (std::size_t i = 0; i < rows; ++i)
            visit(i, row_deviation(&a[i * width], &b[i * width], width), length(&a[i * width], width));
      },
      baseline.values);
}

}  // namespace

ColumnComparison compare_columns(const Column& baseline, const Column& candidate,
                                 const Tolerance& tolerance) {
  ColumnComparison result{baseline.name, baseline.units, tolerance, mismatch(baseline, candidate)};
  const bool measured = has_deviations(baseline);
  double squares = 0;
  std::size_t finite = 0;
  for_rows(baseline, candidate, [&](std::size_t row, double deviation, double size) {
    ++result.rows;
    finite += std::isfinite(deviation) ? 1 : 0;
    if (deviation == 0) return;
    if (!result.first_difference) result.first_difference = row;
    const bool inside = measured && deviation <= tolerance.absolute + tolerance.relative * size;
    if (std::isnan(deviation))
      ++result.not_numbers;
    else if (measured)
      result.largest = std::max(result.largest, deviation), squares += deviation * deviation;
    if (inside) return;
    ++result.outside;
    if (!result.first_outside) result.first_outside = row;
  });
  if (finite > 0) result.rms = std::sqrt(squares / static_cast<double>(finite));
  if (result.rows == 0 && result.problem.empty()) result.problem = "no rows";
  return result;
}

std::vector<double> deviations(const Column& baseline, const Column& candidate) {
  std::vector<double> all;
  for_rows(baseline, candidate, [&](std::size_t, double deviation, double) { all.push_back(deviation); });
  return all;
}

}  // namespace remote_touch
