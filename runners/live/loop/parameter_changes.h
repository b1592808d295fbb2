// Live parameters that change together, on their way to the haptic loop.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace remote_touch {

// parameter: its number in LiveControls::parameters().
struct ParameterChange {
  std::int32_t parameter = 0;
  double value = 0;
};

struct ParameterChanges {
  static constexpr std::size_t kMax = 4;
  std::array<ParameterChange, kMax> list;
  std::size_t count = 0;
  std::span<const ParameterChange> all() const { return {list.data(), count}; }
};

}  // namespace remote_touch
