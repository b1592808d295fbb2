#include "analysis/trace/columns.h"

#include <bit>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <type_traits>

namespace remote_touch {

namespace {

template <class Number>
std::uint64_t word(Number value) {
  if constexpr (std::is_same_v<Number, double>)
    return std::isnan(value) ? 0x7ff8000000000000u
                             : std::bit_cast<std::uint64_t>(value + 0.0);  // -0 + 0 is 0
  else
    return static_cast<std::uint64_t>(value);
}

template <class Number>
void mix_rows(const std::vector<Number>& values, std::size_t width, std::vector<std::uint64_t>& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t k = 0; k < width; ++k) rows[i] = mixed(rows[i], word(values[i * width + k]));
}

void mix_rows(const std::vector<std::string>&, std::size_t, std::vector<std::uint64_t>&) {}

}  // namespace

std::vector<std::string> names_of(const std::vector<Column>& columns) {
  std::vector<std::string> names;
  for (const Column& column : columns) names.push_back(column.name);
  return names;
}

std::string joined(const std::vector<std::string>& names, const char* separator) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : separator) + name;
  return all;
}

std::vector<std::string> split_names(const std::string& joined) {
  std::vector<std::string> list;
  std::istringstream text(joined);
  text.exceptions(std::ios::badbit);  // throws if memory runs out, instead of ending the list early
  for (std::string name; std::getline(text, name, ',');) list.push_back(name);
  return list;
}

const std::vector<double>& numbers(const Table& table, const std::string& column) {
  for (const Column& candidate : table.columns)
    if (candidate.name == column) return std::get<std::vector<double>>(candidate.values);
  throw std::out_of_range(table.name + " has no column " + column);
}

Tolerance tolerance_of(const Tolerances& tolerances, const std::string& name) {
  for (const std::string& key : {name, std::string("*")})
    if (const auto found = tolerances.find(key); found != tolerances.end()) return found->second;
  return {};
}

bool within(const Tolerance& tolerance, double baseline, double candidate) {
  if (std::isnan(baseline) || std::isnan(candidate)) return std::isnan(baseline) && std::isnan(candidate);
  if (baseline == candidate) return true;
  if (!std::isfinite(baseline) || !std::isfinite(candidate)) return false;
  return std::abs(candidate - baseline) <= tolerance.absolute + tolerance.relative * std::abs(baseline);
}

std::uint64_t points_hash(const PointCloud& cloud) {
  std::uint64_t sum = cloud.size();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    std::uint64_t point = mixed(mixed(mixed(1, word(cloud.x[i])), word(cloud.y[i])), word(cloud.z[i]));
    if (!cloud.fixture_radius_m.empty()) point = mixed(point, word(cloud.fixture_radius_m[i]));
    if (!cloud.stiffness_N_per_m.empty()) point = mixed(point, word(cloud.stiffness_N_per_m[i]));
    if (cloud.has_normals())
      point = mixed(mixed(mixed(point, word(cloud.nx[i])), word(cloud.ny[i])), word(cloud.nz[i]));
    sum += mixed(point, point >> 29);  // terms of a sum have to look random in every bit
  }
  return sum;
}

std::vector<std::uint64_t> running_hash(const std::vector<Column>& columns) {
  std::vector<std::uint64_t> hashes(columns.empty() ? 0 : columns.front().length(), 0);
  for (const Column& column : columns)
    std::visit([&](const auto& v) { mix_rows(v, static_cast<std::size_t>(column.width), hashes); },
               column.values);
  std::uint64_t chain = 0;
  for (std::uint64_t& hash : hashes) hash = chain = mixed(chain, hash);
  return hashes;
}

}  // namespace remote_touch
