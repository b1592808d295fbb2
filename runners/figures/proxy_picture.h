// Tables that a picture of a proxy in a cloud is drawn from, as in Figs 4.10 and 5.9.
#pragma once

#include <string>
#include <vector>

#include "core/cloud/point_cloud.h"
#include "runners/figures/figures.h"

namespace remote_touch {

// Adds the chosen points, and a tick of a trace: the proxy as a ball of radius r_c, the HIP as a smaller one,
// the normal as a pin in the proxy, and the force on the hand from the HIP on. Tables are NAME_cloud,
// NAME_proxy, NAME_hip, NAME_triangles, NAME_poses, NAME_normal and NAME_force.
void add_proxy_tables(Figure& figure, const std::string& name, const PointCloud& cloud,
                      const std::vector<std::size_t>& chosen, const Trace& trace, std::size_t tick,
                      double force_m_per_N);

// point_m: diameter of a point.
std::vector<ScenePart> proxy_in_cloud(const std::string& name, double point_m);

// Points of a cloud in a box around a place, up to so far along each axis.
std::vector<std::size_t> points_near(const PointCloud& cloud, const Vec3& place_W, const Vec3& reach_m);

}  // namespace remote_touch
