// A surface with forbidden regions, a HIP that slides below it, and proxy positions in each of the three
// states.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/search/neighbour_search.h"
#include "tests/benchmarks/naive_regions.h"
#include "tests/benchmarks/slide.h"

namespace remote_touch::benchmarks {

// One kind of step. It begins at a proxy position with a HIP.
struct FixtureSteps {
  std::string name;
  ContactState state;
  std::vector<Vec3> proxies = {}, hips = {};
  std::vector<naive::RegionStep> expected = {};  // one for every kFixtureCheckEvery-th step
};

constexpr std::size_t kFixtureCheckEvery = 64;
// Number of ticks that are compared. It is small because the proxy moves to and fro where regions of
// different sizes meet, and a rounding difference grows tenfold per tick.
constexpr std::size_t kFixtureCheckedTicks = 10;

// Its queries are the lists that the renderer gathers. Each ball touches the region of a random point, so
// branches are new.
struct FixtureScene : naive::Queries {
  std::shared_ptr<const NeighbourSearch> search = nullptr;
  std::vector<FixtureSteps> steps = {};
  std::vector<Vec3> expected_ticks = {};  // proxies after whole ticks; the first begins and ends above
};

// An image of 640x480 points at about 0.5 m, 1 mm apart: without radii; all radii 0; all radii 0.02 m; half
// of the points, those on one side, with 0.02 m; all radii 0.02 m, and a stiffness except at every third
// point.
std::vector<FixtureScene> fixture_scenes();

// Position of the HIP during the slide below the surface, and the position above all regions where it waits
// before the slide.
Vec3 fixture_hip_at(double time_s);
Vec3 fixture_hip_above();

}  // namespace remote_touch::benchmarks
