// Collision detection of other libraries between the mesh of a tool and points, behind plain numbers, because
// their headers and ours need different settings of Eigen.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace remote_touch::peers {

using Coordinates = std::array<double, 3>;  // metres

struct MeshAndPoints {
  std::vector<Coordinates> vertices;  // tool frame
  std::vector<std::array<int, 3>> triangles;
  std::vector<Coordinates> points_W, normals_W;
};

struct Pose {
  Coordinates p_W;             // origin of the tool frame
  std::array<double, 9> R_WT;  // row by row
};

// Other libraries have no points, only bodies, so each point gets a small body around it.
struct ToolPeer {
  std::string name;
  std::vector<std::vector<Coordinates>> bodies_W;  // corners of the convex body of every point
  // Largest distance from the surface, outside and inside, of a point whose body is found.
  double max_outside_m, max_inside_m;
  // Does the work that is timed, and returns the number of contacts. A body has one with each triangle that
  // it meets.
  std::function<std::size_t(const Pose&)> touch;
  std::function<std::vector<std::size_t>()> touched;  // points of the last touch(), some more than once
};

// Each peer uses one thread. Trees are made here, not in touch().
std::vector<ToolPeer> tool_peers(const MeshAndPoints& from);

}  // namespace remote_touch::peers
