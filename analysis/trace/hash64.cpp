#include "analysis/trace/hash64.h"

#include <bit>
#include <cmath>
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
