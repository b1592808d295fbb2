// Surface disks near a tool, 6.2.2: their place, the trilinear distance field there and how much nearer any
// place of a disk can be. The operations are those of voxel_tool.cpp and disk_contact.cpp, each sum in the
// order in which Eigen adds three terms.
#include <math.h>

#include "core/kernels/level.h"
#include "core/kernels/tool_kernels.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

namespace {

inline double dot(double ax, double ay, double az, double bx, double by, double bz) {
  return ax * bx + (ay * by + az * bz);
}

inline double clamped(double u, double cells) {
  const double above = u > 0 ? u : 0;
  return above < cells ? above : cells;
}

// As cell_number() does it.
inline std::uint64_t cell_along(double x, double per_m) {
  return __builtin_bit_cast(std::uint64_t, x * per_m - kAlmostHalf + kRoundsToWhole) & 0xfffff;
}

// From the sign of its opposite, without a branch.
inline std::uint64_t is_positive(double x) {
  return __builtin_bit_cast(std::uint64_t, 0 - x) >> 63;
}

}  // namespace

void disks_in_field(const PointColumns& points, const std::uint32_t* index, std::size_t count,
                    double fraction, double cells_per_m, const PosedField& f, const DiskColumns& out) {
  const double cells[3] = {double(f.cells[0]), double(f.cells[1]), double(f.cells[2])};
  const int last[3] = {f.cells[0] - 1, f.cells[1] - 1, f.cells[2] - 1};
  const int row = f.cells[0] + 1, layer = row * (f.cells[1] + 1);
  const auto& R = f.R_TW;
#pragma omp simd
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t i = index[k];
    const double wx = points.x[i] - f.p_W[0], wy = points.y[i] - f.p_W[1], wz = points.z[i] - f.p_W[2];
    const double px = dot(R[0][0], R[0][1], R[0][2], wx, wy, wz),
                 py = dot(R[1][0], R[1][1], R[1][2], wx, wy, wz),
                 pz = dot(R[2][0], R[2][1], R[2][2], wx, wy, wz);
    const double mx = points.nx[i], my = points.ny[i], mz = points.nz[i];
    const double nx = dot(R[0][0], R[0][1], R[0][2], mx, my, mz),
                 ny = dot(R[1][0], R[1][1], R[1][2], mx, my, mz),
                 nz = dot(R[2][0], R[2][1], R[2][2], mx, my, mz);
    const double radius = fraction * points.spacing[i];

    const double u = (px - f.origin_T[0]) / f.size, v = (py - f.origin_T[1]) / f.size,
                 w = (pz - f.origin_T[2]) / f.size;
    const double in_u = clamped(u, cells[0]), in_v = clamped(v, cells[1]), in_w = clamped(w, cells[2]);
    const int cu = static_cast<int>(in_u), cv = static_cast<int>(in_v), cw = static_cast<int>(in_w);
    const int a = cu < last[0] ? cu : last[0], b = cv < last[1] ? cv : last[1],
              c = cw < last[2] ? cw : last[2];
    const double x = in_u - a, y = in_v - b, z = in_w - c;
    const int n = a + row * b + layer * c;
    const double n000 = f.node[n], n100 = f.node[n + 1], n010 = f.node[n + row], n110 = f.node[n + row + 1];
    const double n001 = f.node[n + layer], n101 = f.node[n + layer + 1], n011 = f.node[n + layer + row],
                 n111 = f.node[n + layer + row + 1];
    const double d00 = n100 - n000, d10 = n110 - n010, d01 = n101 - n001, d11 = n111 - n011;
    const double v00 = n000 + x * d00, v10 = n010 + x * d10, v01 = n001 + x * d01, v11 = n011 + x * d11;
    const double v0 = v00 + y * (v10 - v00), v1 = v01 + y * (v11 - v01);
    const double dx0 = d00 + y * (d10 - d00), dx1 = d01 + y * (d11 - d01);
    const double gx = (dx0 + z * (dx1 - dx0)) / f.size,
                 gy = ((v10 - v00) + z * ((v11 - v01) - (v10 - v00))) / f.size, gz = (v1 - v0) / f.size;
    const double distance = v0 + z * (v1 - v0);

    const double steep = dot(gx, gy, gz, nx, ny, nz);
    const double sx = gx - steep * nx, sy = gy - steep * ny, sz = gz - steep * nz;
    const double slope = sqrt(dot(sx, sy, sz, sx, sy, sz));
    const bool has_normal = nx - nx == 0 && ny - ny == 0 && nz - nz == 0;
    const double lower = has_normal ? distance - radius * slope : distance;
    const bool in_grid = in_u == u && in_v == v && in_w == w;
    const std::uint64_t cell =
        cell_along(px, cells_per_m) << 40 | cell_along(py, cells_per_m) << 20 | cell_along(pz, cells_per_m);
    const std::uint64_t octant = is_positive(gx) << 2 | is_positive(gy) << 1 | is_positive(gz);

    out.p_T[0][k] = px, out.p_T[1][k] = py, out.p_T[2][k] = pz;
    out.n_T[0][k] = nx, out.n_T[1][k] = ny, out.n_T[2][k] = nz;
    out.radius[k] = radius;
    out.distance[k] = distance;
    out.gradient_T[0][k] = gx, out.gradient_T[1][k] = gy, out.gradient_T[2][k] = gz;
    out.slope[k] = has_normal ? slope : __builtin_nan("");
    out.lower[k] = in_grid ? lower : __builtin_nan("");
    out.cell[k] = cell << 3 | octant;
  }
}

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
