#include "core/kernels/kernels.h"

#include "core/kernels/level.h"

REMOTE_TOUCH_DECLARE_TABLES(x86_64)
REMOTE_TOUCH_DECLARE_TABLES(x86_64_v3)
REMOTE_TOUCH_DECLARE_TABLES(x86_64_v4)

namespace remote_touch {

namespace {

// NOLINTBEGIN(bugprone-macro-parentheses): level is a namespace
#define REMOTE_TOUCH_KERNELS(name, level)                                                         \
  {                                                                                               \
    .isa = name, .gather = level::kGatherKernels, .proxy = level::kProxyKernels,                  \
    .noise = level::kNoiseKernels, .tool = level::kToolKernels, .regions = level::kRegionKernels, \
    .patch = level::kPatchKernels, .depth = level::kDepthKernels                                  \
  }
// NOLINTEND(bugprone-macro-parentheses)

constexpr Kernels kX86_64 = REMOTE_TOUCH_KERNELS("x86-64", x86_64);
constexpr Kernels kX86_64v3 = REMOTE_TOUCH_KERNELS("x86-64-v3", x86_64_v3);
constexpr Kernels kX86_64v4 = REMOTE_TOUCH_KERNELS("x86-64-v4", x86_64_v4);
constexpr const Kernels* kLevels[] = {&kX86_64, &kX86_64v3, &kX86_64v4};  // same order as Isa

}  // namespace

Isa best_isa() {
  __builtin_cpu_init();
  const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                  __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  const bool v4 = v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                  __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                  __builtin_cpu_supports("avx512vl");
  return v4 ? Isa::x86_64_v4 : v3 ? Isa::x86_64_v3 : Isa::x86_64;
}

const Kernels& kernels_for(Isa isa) {
  return *kLevels[static_cast<int>(isa)];
}

std::span<const Kernels* const> supported_kernels() {
  return std::span(kLevels).first(static_cast<std::size_t>(best_isa()) + 1);
}

}  // namespace remote_touch
