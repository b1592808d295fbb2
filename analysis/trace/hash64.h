// Cheap 64-bit hashes: of the points of a frame, and of a run up to each tick. They show that two things are
// equal, or where they first differ, with one chance in 1.8e19 of being wrong; against deliberate changes
// there is the SHA-256 of the file.
#pragma once

#include <cstdint>
#include <vector>

#include "analysis/trace/column.h"
#include "core/geometry/point_cloud.h"

namespace remote_touch {

// One step of a chain: multiplication by the odd constant of the golden ratio, high bits folded onto low
// ones. Equal on every machine; the same in other languages with 64-bit integers that wrap around.
constexpr std::uint64_t mixed(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
  return hash ^ (hash >> 32);
}

inline constexpr const char* kRunningHash = "tick_hash";  // its column in a trace

// Hash of every coordinate, fixture radius and stiffness of the cloud and of its length; it does not depend
// on the order of the points, which each search chooses.
std::uint64_t points_hash(const PointCloud& cloud);

// The running hash of columns of equal length: row i holds hash_i = mixed(hash_(i-1), r_i), where r_i is the
// chain over the words of row i of every column in turn (doubles as their bits, -0 as 0 and every NaN as
// 0x7ff8000000000000, so that equal rows have equal hashes; integers sign-extended) and both chains begin
// with 0. So the hashes of two runs are equal up to the first tick at which anything differs, and different
// from there on: bisection finds that tick, with log2(ticks) numbers of each run. Texts are ignored.
std::vector<std::uint64_t> running_hash(const std::vector<Column>& columns);

}  // namespace remote_touch
