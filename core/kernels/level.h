// The kernels of one x86-64 level. Each file of this folder is compiled once for each level, into the
// namespace that REMOTE_TOUCH_LEVEL names. They include nothing with inline functions that other files share:
// the linker could keep one level's copy for all of them.
#pragma once

#include "core/kernels/kernels.h"

#define REMOTE_TOUCH_DECLARE_KERNELS(level)                                                                  \
  namespace remote_touch::level {                                                                            \
  std::size_t append_within(const PointRun& run, const double centre[3], double reach,                       \
                            const PointSink& sink, std::size_t count);                                       \
  ContactQuery contact_query(const PointsView& points, const double p[3], const ProxyRegions& regions);      \
  double first_hit(const PointsView& points, const double p[3], const double direction[3], double reach);    \
  double exit_distance(const PointsView& points, const double p[3], const double direction[3], double reach, \
                       double inner);                                                                        \
  void normals(const NoiseStream& stream, const std::uint32_t* index, std::size_t count, double* x,          \
               double* y, double* z);                                                                        \
  std::size_t candidates(const NoiseStream& stream, std::uint32_t first, std::size_t count,                  \
                         const std::uint64_t* x, std::uint64_t z, std::uint32_t* index);                     \
  std::size_t near_spheres(const SphereColumns& spheres, const std::uint32_t* groups,                        \
                           std::size_t group_count, const CellTransform& to_cells, const CellTable& table,   \
                           const NearnessCode& code, std::uint32_t* found);                                  \
  std::size_t points_in_cells(const double* x, const double* y, const double* z,                             \
                              const std::uint32_t* groups, std::size_t group_count,                          \
                              const CellTransform& to_cells, const CellTable& table, int min,                \
                              std::uint32_t* found);                                                         \
  void disks_in_field(const PointColumns& points, const std::uint32_t* index, std::size_t count,             \
                      double fraction, double cells_per_m, const PosedField& field,                          \
                      const DiskColumns& disks);                                                             \
  std::size_t append_near_regions(const SphereRun& run, const double leaf[4], double margin,                 \
                                  const NearRegions& near, std::size_t count);                               \
  std::size_t deepest_region(const NearRegions& near, std::size_t count);                                    \
  RemainingRegions next_deepest_region(const NearRegions& near, std::size_t count, std::size_t kept,         \
                                       double motion, double alike, double max);                             \
  std::size_t points_of_patch(const PointsView& points, const PatchAxes& axes, const PatchColumns& to);      \
  void heights_above(const PatchColumns& places, std::size_t count, const HeightGrid& grid, double* above);  \
  PlaneSums sums_near_plane(const PatchColumns& places, std::size_t count, const double* height,             \
                            const NearPlane& near);                                                          \
  void height_bins(const PatchColumns& places, std::size_t count, const double* height, double u, double v,  \
                   double reach, const HeightBins& bins, std::int32_t* bin);                                 \
  QuadraticSums sums_of_quadratic(const PatchColumns& places, const std::uint8_t* member, std::size_t count, \
                                  double radius);                                                            \
  void depth_to_points(const PixelRow& row, double scale, const PointPlanes& out);                           \
  void filter_depth(const RowBand& band, const PointPlanes& in, float* change);                              \
  void plane_normals(const RowBand& band, const PointPlanes& in, const PixelRays& rays, const float step[2], \
                     const PointPlanes& out);                                                                \
  void points_to_cloud(const PixelRow& row, const double X_WC[12], const CloudRow& out);                     \
  void normals_to_cloud(int width, const float* z, const PointPlanes& normals, const double X_WC[12],        \
                        const CloudRow& out);                                                                \
  }

#ifdef REMOTE_TOUCH_LEVEL
REMOTE_TOUCH_DECLARE_KERNELS(REMOTE_TOUCH_LEVEL)
#endif
