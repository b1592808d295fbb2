#include "runners/evaluation/figures/figure_recipe.h"

namespace remote_touch {

MakeFigure figure_4_10, figure_4_11, figure_4_12, figure_4_13, figure_4_13_replicated, figure_bounds,
    figure_4_14, figure_4_15, figure_4_15_meshes, figure_eq4_15, figure_4_16, figure_4_16_recorded,
    figure_5_5, figure_5_6, figure_5_8, figure_5_9, figure_6_2, figure_6_3, figure_6_3_angles, figure_6_4,
    figure_7_1_recorded, figure_7_4, figure_7_5, figure_7_5_guidance;

// The figures, in the order in which they are listed. Seconds are those on one core of an AMD EPYC with
// AVX-512, with the tools already in the cache. Those of 4.12 and 4.16 are scaled from a core
// that takes five times as long for 4.13.
std::span<const FigureEntry> figures() {
  static constexpr FigureEntry kFigures[] = {
      {"4.10", "the proxy on a flat grid, in 3-D", figure_4_10, 0.05},
      {"4.11", "a flat grid touched from above: proxy height, and the ripple of the contact point",
       figure_4_11, 0.03},
      {"4.12", "a noisy cloud lifted with acceleration: proxy height at each update", figure_4_12, 3},
      {"4.13", "pop-through in 5396 lifts, over noise and acceleration", figure_4_13, 32, true},
      {"4.13-replicated", "a coarser map with 20 lifts a cell: probability of pop-through",
       figure_4_13_replicated, 108, true, 3},
      {"bounds", "the bounds (4.14) to (4.25), their parts measured, and how far they hold", figure_bounds,
       38},
      {"4.14", "the contact point over a triangle wave of growing amplitude", figure_4_14, 0.15},
      {"4.15", "ramp and box as the points of a simulated depth camera, in 3-D", figure_4_15, 0.1},
      {"4.15-meshes",
       "ramp and box as meshes with colours before a simulated Kinect: points, proxy path and gap",
       figure_4_15_meshes, 3.5},
      {"eq4.15", "force between updates of a moving cloud: the sign in equation (4.15)", figure_eq4_15, 0.02},
      {"4.16", "ramp and box seen by a simulated depth camera: proxy path and force", figure_4_16, 2.2},
      {"4.16-recorded", "the experiment of 4.16 on recorded depth images and clouds", figure_4_16_recorded,
       1},
      {"5.5", "the region around a single point, entered and left", figure_5_5, 0.03},
      {"5.6", "the step between two fixture radii, and a stiffness that varies across a plane", figure_5_6,
       0.2},
      {"5.8", "a fixture that grows on a beating organ, seen by a simulated depth camera", figure_5_8, 10},
      {"5.9", "the proxy at the distance of a forbidden region from a beating organ, in 3-D", figure_5_9, 4},
      {"6.2", "a recorded hand as points with normals, and what the filter does to a step", figure_6_2, 0.2},
      {"6.3",
       "a tool turned in a narrow box of points: displacement, rotation, counts of contacts over the spacing of "
       "the points",
       figure_6_3, 7},
      {"6.3-angles", "the tool of 6.3 turned by other angles: where it stops, over spacing and contact rule",
       figure_6_3_angles, 8},
      {"6.4", "a bunny, a hand and a drill slide over recorded objects", figure_6_4, 8},
      {"7.1-recorded", "an organ model and a dragon found by hue in recorded images", figure_7_1_recorded,
       0.3},
      {"7.4", "a tool of spheres is pushed towards two valves with forbidden regions", figure_7_4, 15},
      {"7.5", "guidance leads the hand from one valve to the other, with five and with six motors",
       figure_7_5, 12},
      {"7.5-guidance", "where guidance leads the hand, over its stiffness, with six and with five motors",
       figure_7_5_guidance, 18},
  };
  return kFigures;
}

}  // namespace remote_touch
