// Times of the proxy and of its parts, in nanoseconds. Every benchmark compares its answers with the plain
// ones of naive_proxy.h and naive_regions.h before it is timed, and is skipped with an error if they differ.
// Times have a meaning only as ratios within one run, which scripts/benchmark prints.
#include "tests/benchmarks/proxy_benchmark.h"

#include <benchmark/benchmark.h>

#include <vector>

#include "tests/benchmarks/checked_benchmark.h"
#include "tests/support/scenes.h"

int main(int argc, char** argv) {
  using namespace remote_touch;
  using namespace remote_touch::benchmarks;
  const Slide grid = made({"grid", scenes::flat_grid(100), Vec3(-0.025, 0.02, 0), Vec3(-0.025, -0.005, 0),
                           Vec3(1, 0, 0.3).normalized()});
  const Slide image = made({"image", naive::wave_image(0.75), Vec3(-0.025, 0, 0.7), Vec3(-0.025, 0, 0.775),
                            Vec3(1, 0.3, 0).normalized()});
  const Slide grid_stopped = stopped(grid), image_stopped = stopped(image);
  add_steps(grid, grid_stopped);
  add_steps(image, image_stopped);
  add_ticks(grid);
  add_ticks(image);

  const std::vector<naive::Queries> queries = query_sets();
  for (const naive::Queries& each : queries) add_queries(each);
  add_normals();
  add_programs();

  const std::vector<FixtureScene> fixtures = fixture_scenes();
  for (const FixtureScene& each : fixtures) add_fixtures(each);
  add_assignments();

  return run_benchmarks(argc, argv);
}
