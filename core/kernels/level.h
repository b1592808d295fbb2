// The kernels of one x86-64 level. Each file of this folder is compiled once for each level, into the
// namespace that REMOTE_TOUCH_LEVEL names. These files include no inline functions that other files share,
// because the linker could keep the copy of one level for all of them.
#pragma once

#include "core/kernels/kernels.h"

// Each table is defined after the functions of its domain.
#define REMOTE_TOUCH_DECLARE_TABLES(level)   \
  namespace remote_touch::level {            \
  extern const GatherKernels kGatherKernels; \
  extern const ProxyKernels kProxyKernels;   \
  extern const NoiseKernels kNoiseKernels;   \
  extern const ToolKernels kToolKernels;     \
  extern const RegionKernels kRegionKernels; \
  extern const PatchKernels kPatchKernels;   \
  extern const DepthKernels kDepthKernels;   \
  }

#ifdef REMOTE_TOUCH_LEVEL
REMOTE_TOUCH_DECLARE_TABLES(REMOTE_TOUCH_LEVEL)

namespace remote_touch::REMOTE_TOUCH_LEVEL {

// Kernel<&DepthKernels::filter_depth> is the type of that kernel. It declares the kernel for a table in
// another file.
template <class Member>
struct KernelOfMember;
template <class Table, class Function>
struct KernelOfMember<Function * Table::*> {
  using Type = Function;
};
template <auto kMember>
using Kernel = typename KernelOfMember<decltype(kMember)>::Type;

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
#endif
