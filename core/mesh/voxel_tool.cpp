#include "core/mesh/voxel_tool.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/mesh/distance_field.h"
#include "core/parameters/parameter.h"
#include "core/points/vector.h"

namespace remote_touch {
namespace {

// The first node of the cell that holds `at` (in voxels from the origin), and the position within the cell.
struct InCell {
  std::array<int, 3> cell;
  Vec3 fraction;
};
InCell cell_at(const VoxelGrid& grid, const Vec3& at) {
  InCell in;
  for (int i = 0; i < 3; ++i) {
    in.cell[i] = std::clamp(static_cast<int>(at[i]), 0, grid.cells[i] - 1);
    in.fraction[i] = at[i] - in.cell[i];
  }
  return in;
}

FieldSample trilinear(const VoxelTool& tool, const Vec3& at) {
  const VoxelGrid& grid = tool.grid;
  const auto [cell, fraction] = cell_at(grid, at);
  const std::size_t row = grid.cells[0] + 1, layer = row * (grid.cells[1] + std::size_t(1));
  const float* n = &tool.distance_m[cell[0] + row * cell[1] + layer * cell[2]];
  const double x = fraction.x(), y = fraction.y(), z = fraction.z();
  const double d00 = n[1] - double(n[0]), d10 = n[row + 1] - double(n[row]);
  const double d01 = n[layer + 1] - double(n[layer]), d11 = n[layer + row + 1] - double(n[layer + row]);
  const double v00 = n[0] + x * d00, v10 = n[row] + x * d10;
  const double v01 = n[layer] + x * d01, v11 = n[layer + row] + x * d11;
  const double v0 = v00 + y * (v10 - v00), v1 = v01 + y * (v11 - v01);
  const double dx0 = d00 + y * (d10 - d00), dx1 = d01 + y * (d11 - d01);
  const Vec3 gradient(dx0 + z * (dx1 - dx0), (v10 - v00) + z * ((v11 - v01) - (v10 - v00)), v1 - v0);
  return {v0 + z * (v1 - v0), gradient / grid.size_m};
}

}  // namespace

FieldSample sample_field(const VoxelTool& tool, const Vec3& p_T) {
  const VoxelGrid& grid = tool.grid;
  const Vec3 at = (p_T - grid.origin_T) / grid.size_m;
  const Vec3 last(grid.cells[0], grid.cells[1], grid.cells[2]);
  if ((at.array() >= 0).all() && (at.array() < last.array()).all()) return trilinear(tool, at);
  const Vec3 within = at.cwiseMax(0.0).cwiseMin(last);
  FieldSample sample = trilinear(tool, within);
  if (within == at) return sample;
  const Vec3 out = grid.size_m * (at - within);
  // The gradient leads away from the nearest position of the surface. The field and its gradient at `within`
  // give an estimate of that position.
  const double distance = out.norm();
  sample.gradient_T = (out + sample.distance_m * sample.gradient_T).normalized();
  sample.distance_m += distance;
  return sample;
}

namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& problem) {
  throw InputError(name, problem);
}

// Drops vertices that no triangle uses, because they must not extend the box.
void drop_unused(TriangleMesh& mesh) {
  std::vector<int> now(mesh.vertices.size(), -1);
  std::vector<Vec3> used;
  for (auto& triangle : mesh.triangles)
    for (int& corner : triangle) {
      if (now[corner] < 0) now[corner] = static_cast<int>(used.size()), used.push_back(mesh.vertices[corner]);
      corner = now[corner];
    }
  mesh.vertices = std::move(used);
}

void check_and_mend(TriangleMesh& mesh, const VoxelToolSettings& settings, ToolReport& report,
                    const std::string& name) {
  report.check = check_mesh(mesh);
  if (!report.check.readable()) refuse(name, text(report.check) + ": expected a closed mesh of triangles");
  drop_unused(mesh);
  if (settings.repair && !report.check.closed()) {
    mesh = repair_mesh(mesh, report.repaired);
    if (mesh.triangles.empty())
      refuse(name, "no triangles are left after the repair: expected a closed mesh");
    report.by_winding_number = !check_mesh(mesh).closed();
  } else if (!report.check.closed()) {
    refuse(name, text(report.check) + ": expected a closed mesh, or renderer.tool_repair=true");
  }
  if (report.check.inverted()) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    report.inverted = true;
  }
}

void scale(TriangleMesh& mesh, const VoxelToolSettings& settings, ToolReport& report,
           const std::string& name) {
  const Vec3 sides = bounding_box(mesh.vertices).sizes();
  const double max_length = sides.maxCoeff();
  if (!(max_length > 0) || !std::isfinite(max_length))
    refuse(name, "its size is 0 or infinite: expected a closed mesh");
  const double factor = settings.size_m > 0 ? settings.size_m / max_length : 1;
  for (Vec3& v : mesh.vertices) v *= factor;
  report.sides_m = factor * sides;
  const double cells = cells_around(mesh, settings.voxel_m);
  if (cells > kMaxCells)
    refuse(name, "the mesh is " + std::to_string(report.sides_m.maxCoeff()) + " m long and needs " +
                     std::to_string(std::llround(std::min(cells / 1e6, 1e15))) + " million voxels of " +
                     std::to_string(settings.voxel_m) + " m: expected " +
                     std::to_string(std::llround(kMaxCells / 1e6)) +
                     " million or fewer: set renderer.tool_size_m, or a larger renderer.tool_voxel_m");
}

void centre(VoxelTool& tool, const MassProperties& mass, const std::string& name) {
  if (!(mass.volume_m3 > 0)) refuse(name, "encloses no volume: expected a closed mesh");
  for (Vec3& v : tool.mesh.vertices) v -= mass.centre, tool.reach_m = std::max(tool.reach_m, v.norm());
  tool.volume_m3 = mass.volume_m3;
  tool.inertia_m2 = mass.inertia_m2;
}

// Moves the tool to its frame T, sets its grid and mass properties, and returns the nodes that are inside.
// The mass is computed from these nodes if the mesh is open, else from the mesh.
std::vector<std::uint8_t> place(VoxelTool& tool, const VoxelToolSettings& settings, bool open,
                                const std::string& name) {
  if (open) {
    tool.grid = grid_around(tool.mesh, settings.voxel_m);
    auto inside =
        inside_nodes_of_open(TriangleTree(tool.mesh), tool.grid, crossed_cells(tool.mesh, tool.grid));
    const MassProperties mass = mass_properties(tool.grid, inside);
    centre(tool, mass, name);
    tool.grid.origin_T -= mass.centre;
    return inside;
  }
  centre(tool, mass_properties(tool.mesh), name);
  tool.grid = grid_around(tool.mesh, settings.voxel_m);
  InsideNodes nodes = inside_nodes(tool.mesh, tool.grid);
  if (nodes.negative) refuse(name, "a part of the mesh is inside out: expected all faces to point outwards");
  return std::move(nodes.inside);
}

// True if no interior voxel lies within two cells of a cell.
bool is_thin(const VoxelTool& tool, int i, int j, int k) {
  const auto& cells = tool.grid.cells;
  for (int z = std::max(k - 2, 0); z <= std::min(k + 2, cells[2] - 1); ++z)
    for (int y = std::max(j - 2, 0); y <= std::min(j + 2, cells[1] - 1); ++y) {
      const Voxel* row = &tool.voxels[cells[0] * (y + std::size_t(cells[1]) * z)];
      for (int x = std::max(i - 2, 0); x <= std::min(i + 2, cells[0] - 1); ++x)
        if (row[x] == Voxel::interior) return false;
    }
  return true;
}

void count_voxels(const VoxelTool& tool, ToolReport& report) {
  const auto& cells = tool.grid.cells;
  // The fraction is measured over the cells that the surface crosses, because a part thinner than a voxel has
  // no shell cells.
  const std::vector<std::uint8_t> crossed = crossed_cells(tool.mesh, tool.grid);
  std::size_t surface = 0, thin = 0, shell = 0, interior = 0;
#pragma omp parallel for schedule(dynamic) reduction(+ : surface, thin, shell, interior)
  for (int k = 0; k < cells[2]; ++k)
    for (int j = 0; j < cells[1]; ++j)
      for (int i = 0; i < cells[0]; ++i) {
        const std::size_t cell = i + cells[0] * (j + std::size_t(cells[1]) * k);
        interior += tool.voxels[cell] == Voxel::interior;
        shell += tool.voxels[cell] == Voxel::shell;
        if (crossed[cell]) ++surface, thin += is_thin(tool, i, j, k);
      }
  report.voxels = {tool.voxels.size() - shell - interior, shell, interior};
  report.thin_fraction = static_cast<double>(thin) / static_cast<double>(std::max<std::size_t>(surface, 1));
}

}  // namespace

VoxelTool make_voxel_tool(TriangleMesh mesh, const VoxelToolSettings& settings, ToolReport& report,
                          const std::string& name) {
  report = {};
  check_and_mend(mesh, settings, report, name);
  scale(mesh, settings, report, name);
  VoxelTool tool;
  tool.mesh = std::move(mesh);
  const std::vector<std::uint8_t> inside = place(tool, settings, report.by_winding_number, name);
  tool.distance_m = distance_field(TriangleTree(tool.mesh), tool.grid, inside);
  tool.voxels = voxels_of(tool.grid, tool.distance_m);
  if (settings.outer_field) tool.distance_m = outer_field(tool.mesh, tool.grid, tool.distance_m);
  count_voxels(tool, report);
  if (report.voxels[2] == 0)
    refuse(name, "no voxel of " + std::to_string(settings.voxel_m) +
                     " m lies inside: expected a thicker tool, or a smaller renderer.tool_voxel_m");
  return tool;
}

std::string text(const ToolReport& report) {
  const auto tenths = [](double value) {
    const auto rounded = std::llround(10 * value);
    return std::to_string(rounded / 10) + "." + std::to_string(rounded % 10);
  };
  const Vec3 mm = 1e3 * report.sides_m;
  std::string all = tenths(mm.x()) + " x " + tenths(mm.y()) + " x " + tenths(mm.z()) + " mm, " +
                    text(report.check) + ", " + std::to_string(report.voxels[1]) + " shell and " +
                    std::to_string(report.voxels[2]) + " interior voxels";
  if (report.inverted) all += "; faces turned outwards";
  if (!report.check.closed()) all += "; repaired: " + text(report.repaired);
  if (report.by_winding_number) all += ", still open: solid by winding numbers";
  if (report.thin_fraction >= 0.0005)
    all += "; " + tenths(100 * report.thin_fraction) +
           " % of the surface is on parts thinner than about three voxels";
  return all;
}

namespace {

// I = tr(S) 1 - S for the second moments S = integral of x x^T about the centre.
Eigen::Matrix3d inertia_of(const Eigen::Matrix3d& second_moments) {
  return second_moments.trace() * Eigen::Matrix3d::Identity() - second_moments;
}

}  // namespace

// The integrals over a tetrahedron (0, a, b, c) of volume V are V (a + b + c) / 4 for x, and
// V (s s^T + a a^T + b b^T + c c^T) / 20 for x x^T, with s = a + b + c.
MassProperties mass_properties(const TriangleMesh& mesh) {
  MassProperties all;
  if (mesh.vertices.empty()) return all;
  const Vec3 o = mesh.vertices.front();
  Vec3 first = Vec3::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3 a = mesh.vertices[i] - o, b = mesh.vertices[j] - o, c = mesh.vertices[k] - o;
    const Vec3 sum = a + b + c;
    const double volume = a.dot(b.cross(c)) / 6;
    all.volume_m3 += volume;
    first += volume / 4 * sum;
    second +=
        volume / 20 * (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
  if (all.volume_m3 == 0) return all;
  const Vec3 mean = first / all.volume_m3;
  all.centre = o + mean;
  all.inertia_m2 = inertia_of(second / all.volume_m3 - mean * mean.transpose());
  return all;
}

MassProperties mass_properties(const VoxelGrid& grid, const std::vector<std::uint8_t>& inside_nodes) {
  // The sums are integers in units of the voxel, so that nothing is lost over millions of nodes.
  const std::size_t columns = grid.cells[0] + 1, rows = grid.cells[1] + 1;
  Vec3 first = Vec3::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  double count = 0;
  for (std::size_t n = 0; n < inside_nodes.size(); ++n) {
    if (!inside_nodes[n]) continue;
    const std::size_t i = n % columns, j = n / columns % rows, k = n / columns / rows;
    const Vec3 at(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
    ++count, first += at, second += at * at.transpose();
  }
  MassProperties all;
  if (count == 0) return all;
  const double size = grid.size_m;
  const Vec3 mean = first / count;
  all.volume_m3 = count * size * size * size;
  all.centre = grid.origin_T + size * mean;
  const Eigen::Matrix3d own = Eigen::Matrix3d::Identity() / 12;  // second moments of each cube
  all.inertia_m2 = size * size * inertia_of(second / count - mean * mean.transpose() + own);
  return all;
}

namespace {

struct Chosen {
  double squared_m2;  // squared distance to the middle of the cube
  Vec3 p_T;
};

}  // namespace

Pointshell make_pointshell(const VoxelTool& tool, double spacing_m) {
  const VoxelGrid& grid = tool.grid;
  std::map<std::array<int, 3>, Chosen> cubes;
  std::size_t cell = 0;
  for (int k = 0; k < grid.cells[2]; ++k)
    for (int j = 0; j < grid.cells[1]; ++j)
      for (int i = 0; i < grid.cells[0]; ++i, ++cell) {
        if (tool.voxels[cell] != Voxel::shell) continue;
        const Vec3 p_T = grid.origin_T + grid.size_m * Vec3(i + 0.5, j + 0.5, k + 0.5);
        std::array<int, 3> cube;
        Vec3 middle_T;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const auto at = static_cast<Eigen::Index>(axis);
          cube[axis] = static_cast<int>(std::floor(p_T[at] / spacing_m));
          middle_T[at] = (cube[axis] + 0.5) * spacing_m;
        }
        const Chosen voxel{(p_T - middle_T).squaredNorm(), p_T};
        const auto [place, is_first] = cubes.try_emplace(cube, voxel);
        if (!is_first && voxel.squared_m2 < place->second.squared_m2) place->second = voxel;
      }
  Pointshell shell;
  for (const auto& [cube, chosen] : cubes) {
    const FieldSample at = sample_field(tool, chosen.p_T);
    const double slope = at.gradient_T.norm();
    if (!(slope > 0)) continue;
    const Vec3 out_T = at.gradient_T / slope;
    shell.p_T.emplace_back(chosen.p_T - at.distance_m / slope * out_T);
    shell.n_T.emplace_back(-out_T);
  }
  return shell;
}

}  // namespace remote_touch
