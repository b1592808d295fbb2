// The kernels of one x86-64 level. Each file of this folder is compiled once for each level, into the
// namespace that REMOTE_TOUCH_LEVEL names. They include nothing with inline functions that other files share:
// the linker could keep one level's copy for all of them.
#pragma once

#include "core/kernels.h"

#define REMOTE_TOUCH_DECLARE_KERNELS(level)                                                               \
  namespace remote_touch::level {                                                                         \
  std::size_t append_within(const PointRun& run, const double centre[3], double reach,                    \
                            const PointSink& sink, std::size_t count);                                    \
  Survey survey(const PointsView& points, const double p[3], const ProxyRegions& regions);                \
  double first_hit(const PointsView& points, const double p[3], const double direction[3], double reach); \
  double way_out(const PointsView& points, const double p[3], const double direction[3], double reach,    \
                 double inner);                                                                           \
  void normals(const NoiseStream& stream, const std::uint32_t* index, std::size_t count, double* x,       \
               double* y, double* z);                                                                     \
  std::size_t candidates(const NoiseStream& stream, std::uint32_t first, std::size_t count,               \
                         const std::uint64_t* x, std::uint64_t z, std::uint32_t* index);                  \
  }

#ifdef REMOTE_TOUCH_LEVEL
REMOTE_TOUCH_DECLARE_KERNELS(REMOTE_TOUCH_LEVEL)
#endif
