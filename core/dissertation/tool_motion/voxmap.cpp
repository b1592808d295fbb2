#include "core/dissertation/tool_motion/voxmap.h"

#include <bit>
#include <cmath>

namespace remote_touch {

namespace {

constexpr int kAxisBits = 21;
constexpr double kMaxVoxels = 1 << (kAxisBits - 1);
constexpr std::uint64_t kFree = ~std::uint64_t{0};  // no key has its highest bit

// The multiplier of splitmix64.
constexpr std::uint64_t kMix = 0xbf58476d1ce4e5b9;

}  // namespace

Voxmap::Voxmap(const PointCloud& cloud, double voxel_m)
    : voxel_m_(voxel_m), slots_(std::bit_ceil(2 * cloud.size() + 2), kFree) {
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const std::optional<std::uint64_t> key = key_of(cloud.point(i));
    if (key) slots_[slot_of(*key)] = *key;
  }
}

std::optional<std::uint64_t> Voxmap::key_of(const Vec3& p_W) const {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double voxel = std::floor(p_W[axis] / voxel_m_);
    if (!(voxel >= -kMaxVoxels && voxel < kMaxVoxels)) return {};
    key = key << kAxisBits | static_cast<std::uint64_t>(voxel + kMaxVoxels);
  }
  return key;
}

// Returns the slot that holds the key, or the one in which it would be put.
std::size_t Voxmap::slot_of(std::uint64_t key) const {
  const std::size_t mask = slots_.size() - 1;
  std::uint64_t mixed = (key ^ key >> 30) * kMix;
  mixed ^= mixed >> 31;
  std::size_t slot = mixed & mask;
  while (slots_[slot] != key && slots_[slot] != kFree) slot = (slot + 1) & mask;
  return slot;
}

std::optional<Vec3> Voxmap::surface_middle_W(const Vec3& p_W) const {
  const std::optional<std::uint64_t> key = key_of(p_W);
  if (!key || slots_[slot_of(*key)] != *key) return {};
  const Vec3 voxel = (p_W / voxel_m_).array().floor();
  return Vec3(voxel_m_ * (voxel + Vec3::Constant(0.5)));
}

}  // namespace remote_touch
