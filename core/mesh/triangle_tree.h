// A tree over the triangles of a mesh. It finds the nearest triangle and computes the generalised winding
// number.
#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace remote_touch {

class TriangleTree {
 public:
  explicit TriangleTree(const TriangleMesh& mesh);  // pre: indices in range, vertices finite, not empty

  struct Nearest {
    int face = 0;  // index in the tree's own order, for squared_to() and nearest()
    double squared_m2 = 0;
  };
  // Returns the face that is nearest to p. first: a face from which the search starts; a near one, such as
  // the result for a position close by, makes it fast, but any is correct.
  Nearest nearest(const Vec3& p, int first) const;

  // Gathers all faces within distance_m of p, sorted by distance.
  struct Candidate {
    double distance_m;
    int face;
    Vec3 middle;  // the face lies within radius of it
    double radius;
  };
  void faces_within(const Vec3& p, double distance_m, std::vector<Candidate>& faces) const;

  // Returns the squared distance from p to one face.
  double squared_to(int face, const Vec3& p) const { return squared_to(faces_[face], p); }

  // Returns how often the mesh winds around p, by solid angles: 1 inside and 0 outside of a closed mesh, a
  // value between them where there are gaps (Jacobson 2013). Far triangles are combined by their sum of area
  // vectors (Barill 2018). The result is good to about 0.02.
  double winding_number(const Vec3& p) const;

 private:
  struct Face {
    Vec3 a, ab, ac, normal;  // the normal a unit vector, zero for a triangle without area
    double bb, bc, cc;       // products of ab and ac
  };
  // A node is bounded by a disc rather than a box: a patch of a smooth surface is flat, and a box around it
  // would give a much too small distance.
  struct Node {
    Vec3 centre = Vec3::Zero(), axis = Vec3::UnitX();  // mean position and normal of the triangles below
    double radius = 0, half_height = 0;                // size of the disc, across and along its axis
    double reach = 0;                                  // radius of a ball around the centre
    Vec3 area = Vec3::Zero();                          // area vector
    int left = 0, right = 0;  // children; for a leaf its first face and -(number of faces)
  };

  int build(const TriangleMesh& mesh, std::vector<int>& order, int begin, int end);
  void gather(const TriangleMesh& mesh, const std::vector<int>& order, int begin, int end, Node& node) const;
  static double squared_to(const Face& face, const Vec3& p);
  static double squared_to(const Node& node, const Vec3& p);  // lower bound for all faces below
  static double solid_angle(const Face& face, const Vec3& p);

  std::vector<Face> faces_;
  std::vector<Node> nodes_;
};

}  // namespace remote_touch
