// The parts of proxy_benchmark. Their arguments must live until the benchmarks have run.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tests/benchmarks/fixture_scene.h"
#include "tests/benchmarks/naive_proxy.h"
#include "tests/benchmarks/slide.h"

namespace remote_touch::benchmarks {

// One proxy step. still is stopped(slide).
void add_steps(const Slide& slide, const Slide& still);

// Whole ticks of the renderer.
void add_ticks(const Slide& slide);

// Radius queries around centres that slide and centres that jump, on every available cloud.
std::vector<naive::Queries> query_sets();
void add_queries(const naive::Queries& queries);
void add_query(const std::string& name, const std::shared_ptr<const NeighbourSearch>& search,
               const naive::Queries& queries);

// Steps, lists and ticks among forbidden regions.
void add_fixtures(const FixtureScene& scene);
// The cost per frame of the fixture rules and of the search.
void add_assignments();

// The normals of the noise.
void add_normals();

// Quadratic programs.
void add_programs();

}  // namespace remote_touch::benchmarks
