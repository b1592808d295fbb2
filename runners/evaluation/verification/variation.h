// A transformed scene together with the outputs that a renderer must then give.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/kernels/kernels.h"
#include "runners/evaluation/verification/dimension.h"
#include "runners/evaluation/verification/metamorphic_scene.h"
#include "runners/experiment/catalog/factory.h"

namespace remote_touch {

// Starts as the scene and the outputs of its reference run. The functions below change the scene, and the
// expected outputs if these must change with it.
struct Variation {
  MetamorphicScene scene;
  std::vector<RenderOutput> expected;  // output of each tick
  const Kernels* kernels = nullptr;
  UnitChange units = {};            // change of the renderer's parameters
  bool until_velocity = false;      // compare only until either run has estimated a surface velocity
  double reach_m = 0;               // the renderer's largest length
  ContactModel contact_model = {};  // the renderer's
  bool can_be_mirrored = true;      // false: a tool of unknown shape, or of regions
  std::optional<double> stiffness_N_per_m = {};  // parameter of the renderer, if it has one of that name
  std::optional<double> other_stiffness_N_per_m = {};  // replaces it in the varied run
};

// Multiplies lengths, times and forces, including parameters and k_s of points, by their factors.
void change_units(Variation& variation, const UnitChange& change);

// Moves cloud, camera and path as one rigid body.
void move_rigidly(Variation& variation, const RigidTransform& motion);

// Changes the sign of one coordinate, axis 0 to 2. A tool must be its own mirror image. An image layout
// cannot be mirrored, so the cloud is searched by a grid afterwards.
void mirror(Variation& variation, int axis);

// Replaces the search by that of a grid, or by brute force for cell_m = 0. An organised cloud keeps only the
// number of columns of its layout.
void replace_search(Variation& variation, double cell_m);

// Rebuilds every cloud from the points with the numbers order[0], order[1], ...; -1 stands for a point that
// was not measured. pre: no cloud is an image, see replace_search(). The points are no longer organised.
void reorder(Variation& variation, const std::function<std::vector<int>(int size)>& order);

// Adds points to every cloud, with the columns that it has: r_f = 0, and the cloud's first stiffness.
void add_points(Variation& variation, const std::vector<Vec3>& points_W);

// Inserts a view after each view from index `first` on, which arrives `ticks` later. make() derives it from
// that view and the view before it (itself for the first). Returns the positions of the inserted views in the
// stream.
std::vector<std::size_t> follow_views(
    Variation& variation, std::size_t first, int ticks,
    const std::function<CloudView(const CloudView& view, const CloudView& previous)>& make);

}  // namespace remote_touch
