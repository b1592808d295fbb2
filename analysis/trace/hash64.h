// Cheap 64-bit hashes of the points of a frame, and of a run up to each tick. They show whether two frames or
// runs are equal, or at which tick two runs first differ; the chance of an error is 1 in 1.8e19. Only the
// SHA-256 of the file detects deliberate changes.
#pragma once

#include <cstdint>
#include <vector>

#include "analysis/trace/column.h"
#include "core/points/point_cloud.h"

namespace remote_touch {

// One step of a chain: multiplication by the odd constant of the golden ratio, high bits folded onto low
// ones. The result is equal on every machine, and in every language with 64-bit integers that wrap around.
constexpr std::uint64_t mixed(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
  return hash ^ (hash >> 32);
}

inline constexpr const char* kRunningHash = "tick_hash";  // its column in a trace

// Hash of the number of points and of every coordinate, fixture radius, stiffness and normal of the cloud. It
// does not depend on the order of the points, which each search chooses.
std::uint64_t points_hash(const PointCloud& cloud);

// Returns the running hash of columns of equal length. Row i holds hash_i = mixed(hash_(i-1), r_i), where r_i
// is the chain over the words of row i of every column in turn. Both chains begin with 0. The word of a
// double is its bits, with -0 as 0 and every NaN as 0x7ff8000000000000, so that equal rows have equal hashes.
// The word of an integer is the sign-extended integer. Texts are ignored.
// The hashes of two runs are equal up to the first tick at which anything differs, and different from there
// on. Bisection therefore finds that tick from about log2(ticks) hashes of each run.
std::vector<std::uint64_t> running_hash(const std::vector<Column>& columns);

}  // namespace remote_touch
