// A rigid tool in the form that collision detection needs, 6.2.2: voxels of three values, and the distance
// field of its mesh. The tool frame T has its origin in the centre of mass and the axes of the mesh; metres.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/points/vector.h"

namespace remote_touch {

class TriangleTree;

// A point in the shell is in contact with the tool, one in the interior collides with it.
enum class Voxel : std::int8_t { free = 0, shell = 1, interior = 2 };

// Cell (i, j, k) spans origin + size (i .. i + 1, j .. j + 1, k .. k + 1). Cells and nodes are stored with i
// running fastest; there is one node more than cells along every axis.
struct VoxelGrid {
  Vec3 origin_T = Vec3::Zero();
  double size_m = 5e-4;
  std::array<int, 3> cells{0, 0, 0};

  std::size_t cell_count() const { return std::size_t(cells[0]) * cells[1] * cells[2]; }
  std::size_t node_count() const {
    return (std::size_t(cells[0]) + 1) * (std::size_t(cells[1]) + 1) * (std::size_t(cells[2]) + 1);
  }
};

struct VoxelTool {
  TriangleMesh mesh;              // tool frame; closed, except for parts that a repair left open
  VoxelGrid grid;                 // encloses the mesh and kFieldMargin_m around it
  std::vector<Voxel> voxels;      // value of every cell, see voxels_of()
  std::vector<float> distance_m;  // distance to the mesh at every node, positive outside
  double volume_m3 = 0;
  // Inertia about the centre of mass in tool axes, of uniform density, divided by the mass: the lower right
  // block of M of (6.4) for a tool of 1 kg.
  Eigen::Matrix3d inertia_m2 = Eigen::Matrix3d::Identity();
  double reach_m = 0;  // largest distance of a vertex from the origin
};

// Margin of the distance field around the mesh.
inline constexpr double kFieldMargin_m = 6e-3;

struct FieldSample {
  double distance_m;  // positive outside the tool
  Vec3 gradient_T;    // gradient of the trilinear field, out of the tool; about 1 long, not normalised
};

// Returns the trilinear field. The distance at a position outside the grid is the distance to the grid's box
// plus the field at the nearest position of the box. It is at most a voxel less than the true distance;
// beside the edges and corners of the box it can be millimetres more. The gradient outside has unit length
// and leads away from the nearest position of the surface, as the field at the box estimates it.
FieldSample sample_field(const VoxelTool& tool, const Vec3& p_T);

struct VoxelToolSettings {
  double voxel_m = 5e-4;
  double size_m = 0;    // longest side of the mesh's box; 0: the mesh is in metres
  bool repair = false;  // accept a mesh that is not closed, see repair_mesh()
  // Lowers distance_m as distance_field.h describes, so that the field is nowhere positive in a closed tool.
  // The voxels do not change.
  bool outer_field = false;
};

// The changes that were made to a mesh, and how well voxels fit it.
struct ToolReport {
  MeshCheck check;                      // check of the mesh as given
  Vec3 sides_m = Vec3::Zero();          // sides of its box, after scaling
  bool inverted = false;                // all faces pointed inwards, and were flipped
  MeshRepair repaired;                  // all zero without repair
  bool by_winding_number = false;       // repaired and still open: inside is by winding numbers
  std::array<std::size_t, 3> voxels{};  // free, shell, interior
  double thin_fraction = 0;             // fraction of the surface farther than two voxels from all interior
};
std::string text(const ToolReport& report);

// Scales the mesh, moves its centre of mass to the origin, and computes its voxels and distance field. name
// is used in messages only. Throws InputError for a mesh that is empty or not closed (without repair), that
// has no volume, vertices that are not finite, corners that are no vertices or a part that is inside out,
// that needs more than kMaxCells voxels, or that is thinner than a voxel everywhere.
inline constexpr double kMaxCells = 150e6;
VoxelTool make_voxel_tool(TriangleMesh mesh, const VoxelToolSettings& settings, ToolReport& report,
                          const std::string& name = "mesh");

// Volume, centre of mass and inertia of a solid of uniform density.
struct MassProperties {
  double volume_m3 = 0;
  Vec3 centre = Vec3::Zero();
  Eigen::Matrix3d inertia_m2 = Eigen::Matrix3d::Zero();  // about the centre, divided by the mass
};

// Computes the exact values, as sums over the tetrahedra between one point and every triangle. pre: a closed
// mesh. If the faces point inwards, the volume is negative; the centre and the inertia are the same.
MassProperties mass_properties(const TriangleMesh& mesh);

// Computes the values from the nodes inside, each as a cube of one voxel. This is for a mesh with gaps, for
// which the sum above has no meaning.
MassProperties mass_properties(const VoxelGrid& grid, const std::vector<std::uint8_t>& inside_nodes);

// The surface of a tool as points with normals: the pointshell of W. McNeely, K. Puterbaugh and J. Troy, "Six
// degree-of-freedom haptic rendering using voxel sampling", SIGGRAPH 1999.
struct Pointshell {
  std::vector<Vec3> p_T, n_T;  // n_T: unit, into the tool

  std::size_t size() const { return p_T.size(); }
};

// Returns one point for each cube of the tool frame, of side spacing_m, that contains voxels of the shell.
// The point is the middle of that voxel which is nearest to the middle of the cube, moved onto the surface
// along the gradient of the field; no point if the gradient is zero. The source uses the middle of the cube.
Pointshell make_pointshell(const VoxelTool& tool, double spacing_m);

// A mesh as voxels of three values, 6.2.2.

// Returns a grid around the mesh with a margin of kFieldMargin_m or more on every side. The number of cells
// along an axis is odd or even, so that the sides of the mesh's box lie near planes between cells. A side
// through the centres of cells would be bad, because these would be neither inside nor outside. pre: vertices
// finite, at least one.
VoxelGrid grid_around(const TriangleMesh& mesh, double voxel_m);

// Returns the number of cells of grid_around(); a double, so that it cannot overflow.
double cells_around(const TriangleMesh& mesh, double voxel_m);

// Returns 1 for the cells that the surface passes through or touches (separating axes, Akenine-Moeller 2001),
// else 0. The test has a tolerance of 1e-9 voxels, towards 1.
std::vector<std::uint8_t> crossed_cells(const TriangleMesh& mesh, const VoxelGrid& grid);

// The nodes inside a closed mesh. `inside` is 1 for the nodes that the mesh winds around at least once: those
// in the union of parts that overlap, but not those in a hollow. Lines in x through the nodes are crossed
// with the mesh, in integers, so that a line through an edge or a corner is counted correctly. The integers
// round y and z by less than a millionth of a voxel, or by more if the grid has more than 1023 cells along y
// or z.
struct InsideNodes {
  std::vector<std::uint8_t> inside;
  bool negative = false;  // some part is inside out, and not a hollow in another
};
InsideNodes inside_nodes(const TriangleMesh& mesh, const VoxelGrid& grid);

// Returns the nodes inside a mesh with gaps: those where the generalised winding number is above 1/2. Only
// every fourth node along each axis is evaluated far from the surface. crossed: the result of
// crossed_cells().
std::vector<std::uint8_t> inside_nodes_of_open(const TriangleTree& tree, const VoxelGrid& grid,
                                               const std::vector<std::uint8_t>& crossed);

// Returns the voxels of the field. A cell is solid if the field in its centre is negative. The shell consists
// of the solid cells that touch a free one, even if only at a corner, so that no step of half a voxel leads
// from outside into the interior. The shell lies inside the surface, so a slab of thickness h has an interior
// of h - 2w, where w is the size of a voxel, 6.2.4.
std::vector<Voxel> voxels_of(const VoxelGrid& grid, const std::vector<float>& distance_m);

}  // namespace remote_touch
