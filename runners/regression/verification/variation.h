// A scene that is told differently, together with what a renderer must then answer.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/kernels/kernels.h"
#include "runners/regression/verification/dimension.h"
#include "runners/regression/verification/metamorphic_scene.h"

namespace remote_touch {

// Begins as the scene and the outputs of its reference run; every function below changes both sides.
struct Variation {
  MetamorphicScene scene;
  std::vector<RenderOutput> expected;  // of each tick
  const Kernels* kernels = nullptr;
  UnitChange units = {};        // of the renderer's parameters
  bool until_velocity = false;  // compared until either run has estimated a surface velocity
  double reach_m = 0;           // the renderer's largest length
  // By the renderer: the world's axes, for its cells, and the number of frames, for the noise it learns,
  // matter.
  bool fits_a_sheet = false;
  bool order_matters = false;                    // to the renderer: of points in rows and columns
  std::optional<double> stiffness_N_per_m = {};  // of the renderer, where it has a parameter of that name
  std::optional<double> other_stiffness_N_per_m = {};  // to be given to it instead
};

// Lengths, times and forces become so many times as large, parameters included. k_s of points follows.
void change_units(Variation& variation, const UnitChange& change);

// Cloud, camera and path move as one rigid body.
void move_rigidly(Variation& variation, const RigidTransform& motion);

// One coordinate changes its sign. A camera cannot follow: the cloud is searched by a grid.
void mirror(Variation& variation, int axis);

// Another way to search; of the layout of an organised cloud nothing is kept but the width of its rows.
// cell_m = 0: look at every point.
void search_by_grid(Variation& variation, double cell_m);

// Rebuilds every cloud from the points with the numbers order[0], order[1], ...; -1 stands for a point that
// was not measured. For points that are searched by a grid; they are no longer organised.
void reorder(Variation& variation, const std::function<std::vector<int>(int size)>& order);

// More points of every cloud, with the columns that it has: no region of their own, the cloud's first
// stiffness.
void add_points(Variation& variation, const std::vector<Vec3>& points_W);

// The views from number first on are each followed, so many ticks later, by what make() derives from it and
// the view before it (itself for the first). Returns the followers' places in the stream.
std::vector<std::size_t> follow_views(
    Variation& variation, std::size_t first, int ticks,
    const std::function<CloudView(const CloudView& view, const CloudView& previous)>& make);

}  // namespace remote_touch
