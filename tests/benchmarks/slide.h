// A HIP that slides below a surface, and the answers of the plain method of naive_proxy.h on its way.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "core/dissertation/proxy/proxy_step.h"
#include "core/search/neighbour_search.h"
#include "tests/benchmarks/naive_proxy.h"

namespace remote_touch::benchmarks {

inline const ProxyParameters kSettings;
constexpr double kTickRate_hz = 1000;
constexpr std::size_t kCheckEvery = 8, kCheckedTicks = 20;

// A cloud, and a HIP that slides below its surface at 0.1 m/s.
struct Slide {
  std::string name;
  PointCloud cloud;
  Vec3 above, start, direction;  // HIP: it starts above the surface, then jumps to start
  std::shared_ptr<const NeighbourSearch> search = nullptr;
  std::vector<Vec3> points = {};                 // the cloud as the plain method reads it
  std::vector<Vec3> proxies = {}, hips = {};     // single steps in contact state
  std::vector<naive::Step> expected_steps = {};  // one for every kCheckEvery-th step
  std::vector<Vec3> expected_ticks = {};         // proxies after whole ticks
  double within_r3 = 0;                          // points within r3 of a proxy, on average
};

// Fills in all members that have a default above.
Slide made(Slide slide);

// The slide stopped at its first step, so that one list is enough.
Slide stopped(const Slide& slide);

Vec3 hip_at(const Slide& slide, double time_s);

}  // namespace remote_touch::benchmarks
