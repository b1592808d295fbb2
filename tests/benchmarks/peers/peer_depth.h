// Filters and normals of others for organised clouds, behind plain numbers: their headers and ours want
// different settings of Eigen.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tests/benchmarks/peers/published_normals.h"

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
// Filters of depths by name, for those normals that are computed from a depth image; each writes its image.
std::vector<std::pair<std::string, std::function<void(std::vector<float>&)>>> prefilters(
    const DepthOfCamera& depth);

}  // namespace remote_touch::peers
