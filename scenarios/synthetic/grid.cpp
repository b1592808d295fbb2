#include "scenarios/synthetic/grid.h"

#include <numeric>
#include <vector>

namespace remote_touch {

Parameters parameters(Grid& grid) {
  return {
      {"columns", &grid.columns, 1, 4096, "points along x"},
      {"rows", &grid.rows, 1, 4096, "points along z"},
      {"spacing_m", &grid.spacing_m, 1e-5, 1, "distance between neighbouring points, s_xz of Table 4.2"},
      {"phase_x", &grid.phase_x, -1, 1, "shift of the grid along x, in units of the spacing"},
      {"phase_z", &grid.phase_z, -1, 1, "shift of the grid along z, in units of the spacing"},
  };
}

void add_noise(PointCloud& cloud, double sigma_m, const NoiseStream& stream, const Kernels& kernels) {
  if (sigma_m == 0) return;
  std::vector<std::uint32_t> index(cloud.size());
  std::iota(index.begin(), index.end(), 0u);
  std::vector<double> nx(cloud.size()), ny(cloud.size()), nz(cloud.size());
  kernels.noise.normals(stream, index.data(), index.size(), nx.data(), ny.data(), nz.data());
  for (std::size_t i = 0; i < cloud.size(); ++i)
    cloud.x[i] += sigma_m * nx[i], cloud.y[i] += sigma_m * ny[i], cloud.z[i] += sigma_m * nz[i];
}

}  // namespace remote_touch
