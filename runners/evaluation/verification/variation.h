// A transformed scene together with the outputs that a renderer must then give.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "runners/evaluation/verification/contact_model.h"
#include "runners/evaluation/verification/verification_scenes.h"

namespace remote_touch {

// The dimensions of a renderer's parameters, from the unit that ends their names, so that a scene and a
// renderer can be converted together to other units of length, time and force.

// Factors by which every length, time and force is multiplied.
struct UnitChange {
  double length = 1;
  double time = 1;
  double force = 1;

  double factor(const Dimension& dimension) const;  // exact if the changes are powers of two
};

// Returns the dimension of a number with that name. "r1_m" is {1, 0, 0} and "damping_Ns_per_m" is {-1, 1, 1}.
// "gamma" has no underscore and is a pure number. Throws InputError, about that name, for an ending that is
// not in known_units(): a wrong guess would make every check by units worthless.
Dimension dimension_of(const std::string& name);

// Multiplies every number by its factor, each column of Rows by its own. Choices, texts, switches and
// integers are not changed. Throws InputError for a name without a known dimension, an integer that would
// have to change, and a number that leaves its allowed range.
void change_units(const Parameters& parameters, const UnitChange& change);

// Returns the largest magnitude of the parameters that are lengths, m; 0 if no parameter is a length.
double max_length_m(const Parameters& parameters);

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
