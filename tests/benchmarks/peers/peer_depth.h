// Normals of other libraries for organised clouds, behind plain numbers, because their headers
// and ours need different settings of Eigen.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace remote_touch::peers {

struct OrganisedPoints {
  int width, height;
  double focal, cx, cy;
  std::vector<float> xyz;  // three numbers per pixel, in the camera frame
};

// run() does the work that is timed, on a copy of the points in the peer's own form. result() then has three
// numbers per pixel: a normal with any sign.
struct Peer {
  std::string name;
  std::function<void()> run;
  std::function<std::vector<float>()> result;
};

// Each peer uses one thread.
std::vector<Peer> normals_of_others(const OrganisedPoints& points);

}  // namespace remote_touch::peers
