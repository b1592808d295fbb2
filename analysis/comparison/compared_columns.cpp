#include "analysis/comparison/compared_columns.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "analysis/storage/hdf5_file.h"
#include "analysis/storage/result_file.h"
#include "analysis/trace/trace.h"

namespace remote_touch {

bool ColumnSource::has(const std::string& name) const {
  const std::vector<std::string> names = column_names();
  return std::find(names.begin(), names.end(), name) != names.end();
}

StoredTrace::StoredTrace(Hdf5Reader hdf5) : StoredColumns(std::move(hdf5), "/trace/") {
  hdf5_.require_kind("trace", "a trace of remote-touch run or replay");
  column_names_ = split_names(attribute(hdf5_.attributes(), "columns"));
}

std::vector<std::uint64_t> StoredTrace::running_hash() const {
  return hdf5_.values<std::uint64_t>(group_ + kRunningHash);
}

StoredFigure::StoredFigure(Hdf5Reader hdf5) : StoredColumns(std::move(hdf5), "/tables/") {
  hdf5_.require_kind("figure", "a figure of remote-touch figure");
  for (const std::string& path : hdf5_.datasets())
    if (path.starts_with(group_)) column_names_.push_back(path.substr(group_.size()));
}

const Column& ColumnsInMemory::find(const std::string& name) const {
  for (const Column& column : all_)
    if (column.name == name) return column;
  throw std::out_of_range("no column " + name);
}

Column ColumnsInMemory::rows(const std::string& name, std::size_t first, std::size_t count) const {
  Column some = find(name);
  const auto width = static_cast<std::ptrdiff_t>(some.width);
  std::visit(
      [&](auto& values) {
        const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first) * width;
        values = std::decay_t<decltype(values)>(begin, begin + static_cast<std::ptrdiff_t>(count) * width);
      },
      some.values);
  return some;
}

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

TickHashes hashes_of_trace(const StoredTrace& trace, int every) {
  const std::vector<std::uint64_t> all = trace.running_hash();
  TickHashes some;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i % static_cast<std::size_t>(every) != 0 && i + 1 != all.size()) continue;
    some.tick.push_back(static_cast<std::int32_t>(i));
    some.hash.push_back(all[i]);
  }
  return some;
}

void write_hashes(const std::filesystem::path& file, const TickHashes& hashes,
                  const TextAttributes& provenance) {
  Hdf5Writer hdf5;
  hdf5.attribute("/", "schema", schema_name("hashes"));
  hdf5.attributes("/", provenance);
  hdf5.group("/hashes");
  hdf5.columns("/hashes",
               {{"tick", "1", "number of the haptic tick", hashes.tick},
                {"tick_hash", "1", "64-bit hash of all columns up to this tick", hashes.hash}},
               "tick");
  hdf5.save(file);
}

StoredHashes read_hashes(const Hdf5Reader& hdf5) {
  hdf5.require_kind("hashes", "the result of remote-touch hashes");
  StoredHashes stored{
      {hdf5.values<std::int32_t>("/hashes/tick"), hdf5.values<std::uint64_t>("/hashes/tick_hash")},
      hdf5.attributes()};
  const std::vector<std::int32_t>& tick = stored.hashes.tick;
  if (tick.size() != stored.hashes.hash.size()) hdf5.damaged("its ticks and hashes differ in number");
  for (std::size_t i = 0; i < tick.size(); ++i)
    if (tick[i] < 0 || (i > 0 && tick[i] <= tick[i - 1])) hdf5.damaged("its ticks are out of order");
  return stored;
}

HashComparison compare_hashes(const TickHashes& baseline, const TickHashes& candidate) {
  HashComparison result;
  result.same_length =
      !baseline.tick.empty() && !candidate.tick.empty() && baseline.tick.back() == candidate.tick.back();
  for (std::size_t i = 0, j = 0; i < baseline.tick.size() && j < candidate.tick.size();) {
    if (baseline.tick[i] < candidate.tick[j]) {
      ++i;
    } else if (baseline.tick[i] > candidate.tick[j]) {
      ++j;
    } else {
      ++result.compared;
      const int tick = baseline.tick[i];
      const bool same = baseline.hash[i++] == candidate.hash[j++];
      if (same)
        result.same = tick;
      else if (!result.different)
        result.different = tick;
    }
  }
  return result;
}

}  // namespace remote_touch
