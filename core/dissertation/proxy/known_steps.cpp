#include "core/dissertation/proxy/known_steps.h"

#include <array>
#include <bit>
#include <cstddef>

namespace remote_touch {

namespace {

// Binary logarithm of the number of entries. Cycles of more positions are rare.
constexpr std::size_t kEntryBits = 8;

std::array<std::uint64_t, 3> bits(const Vec3& v) {
  return {std::bit_cast<std::uint64_t>(v.x()), std::bit_cast<std::uint64_t>(v.y()),
          std::bit_cast<std::uint64_t>(v.z())};
}

// Returns the index of the entry of a position. The factors are odd and without structure, so the upper bits
// of the sum depend on all bits of the position.
std::size_t entry_of(const Vec3& v) {
  const auto [x, y, z] = bits(v);
  return (x * 0x9E3779B97F4A7C15u + y * 0xC2B2AE3D27D4EB4Fu + z * 0x165667B19E3779F9u) >> (64 - kEntryBits);
}

}  // namespace

KnownSteps::KnownSteps() : entries_(std::size_t{1} << kEntryBits) {}

void KnownSteps::set_hip(const Vec3& hip_W) {
  if (bits(hip_W) == bits(hip_W_)) return;
  hip_W_ = hip_W;
  forget();
}

const KnownStep* KnownSteps::from(const Vec3& proxy_W) const {
  const Entry& entry = entries_[entry_of(proxy_W)];
  return entry.generation == generation_ && bits(entry.step.proxy_W) == bits(proxy_W) ? &entry.step : nullptr;
}

void KnownSteps::remember(const KnownStep& step) {
  entries_[entry_of(step.proxy_W)] = {generation_, step};
}

}  // namespace remote_touch
