// Surface disks near a tool, 6.2.2: their place, the trilinear distance field there and how much nearer any
// place of a disk can be. The operations are those of voxel_tool.cpp and disk_contact.cpp, in their order.
#include "core/kernels/field_lanes.h"
#include "core/kernels/level.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

namespace {

// As cell_number() does it.
inline Flags cell_along(Doubles x, double per_m) {
  return (Flags)(x * per_m - kAlmostHalf + kRoundsToWhole) & 0xfffff;
}

// 1 or 0, from the sign of its opposite.
inline Flags is_positive(Doubles x) {
  return (Flags)(0 - x) < 0 ? Flags{} + 1 : Flags{};
}

inline Doubles3 rotated(const double (&R)[3][3], const Doubles3& a) {
  return {R[0][0] * a.x + (R[0][1] * a.y + R[0][2] * a.z), R[1][0] * a.x + (R[1][1] * a.y + R[1][2] * a.z),
          R[2][0] * a.x + (R[2][1] * a.y + R[2][2] * a.z)};
}

struct PointLanes {
  Doubles3 p_W, n_W;
  Doubles spacing, extent;
};

constexpr int kColumns = 14;
struct DiskLanes {
  Doubles column[kColumns];  // p_T, n_T, radius, distance, gradient_T, slope, lower, cell
};

inline DiskLanes measured(const PointLanes& points, double fraction, double cells_per_m,
                          const PosedField& f) {
  const Doubles3 p =
      rotated(f.R_TW, {points.p_W.x - f.p_W[0], points.p_W.y - f.p_W[1], points.p_W.z - f.p_W[2]});
  const Doubles3 n = rotated(f.R_TW, points.n_W);
  const Doubles radius = fraction * points.spacing + points.extent;
  const FieldLanes at = sample(f, p);
  const Doubles3& g = at.gradient_T;
  const Doubles slope = norm(g - dot(g, n) * n);
  const Flags has_normal = (n.x - n.x == 0) & (n.y - n.y == 0) & (n.z - n.z == 0);
  const Doubles lower = has_normal ? at.distance - radius * slope : at.distance;
  const Doubles none = all(__builtin_nan(""));
  const Flags cell =
      cell_along(p.x, cells_per_m) << 40 | cell_along(p.y, cells_per_m) << 20 | cell_along(p.z, cells_per_m);
  const Flags octant = is_positive(g.x) << 2 | is_positive(g.y) << 1 | is_positive(g.z);
  return {{p.x, p.y, p.z, n.x, n.y, n.z, radius, at.distance, g.x, g.y, g.z, has_normal ? slope : none,
           at.is_known ? lower : none, (Doubles)(cell << 3 | octant)}};
}

// All but the cells, which are numbers of their own.
inline void gather_columns(const DiskColumns& out, double* (&column)[kColumns - 1]) {
  for (int axis = 0; axis < 3; ++axis)
    column[axis] = out.p_T[axis], column[3 + axis] = out.n_T[axis], column[8 + axis] = out.gradient_T[axis];
  column[6] = out.radius, column[7] = out.distance, column[11] = out.slope, column[12] = out.lower;
}

}  // namespace

void disks_in_field(const PointColumns& points, std::size_t count, double fraction, double cells_per_m,
                    const PosedField& f, const DiskColumns& out) {
  double* column[kColumns - 1];
  gather_columns(out, column);
  for (std::size_t i = 0; i < count; i += kDoubles) {
    const DiskLanes disks = measured({{load(points.x + i), load(points.y + i), load(points.z + i)},
                                      {load(points.nx + i), load(points.ny + i), load(points.nz + i)},
                                      load(points.spacing + i),
                                      load(points.extent + i)},
                                     fraction, cells_per_m, f);
    for (int c = 0; c < kColumns - 1; ++c) store(column[c] + i, disks.column[c]);
    __builtin_memcpy(out.cell + i, &disks.column[kColumns - 1], sizeof(Doubles));
  }
}

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
