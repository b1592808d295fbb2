// Filters and normals of others for organised clouds, behind plain numbers: their headers and ours want
// different settings of Eigen.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace remote_touch::peers {

struct OrganisedPoints {
  int width, height;
  double focal, cx, cy;
  std::vector<float> xyz;  // three numbers a pixel, in the camera frame
};

// run() does the work that is timed, on a copy of the points in the peer's own form; result() then has three
// numbers a pixel: a normal with any sign, or for a filter a point.
struct Peer {
  std::string name;
  std::function<void()> run;
  std::function<std::vector<float>()> result;
};

// One thread each.
std::vector<Peer> normals_of_others(const OrganisedPoints& points);
std::vector<Peer> filters_of_others(const OrganisedPoints& points);

}  // namespace remote_touch::peers
