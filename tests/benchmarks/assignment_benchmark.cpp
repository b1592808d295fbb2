// The preparation of a frame: the columns of each fixture rule, (5.2), and the search.
#include <benchmark/benchmark.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/dissertation/virtual_fixtures/fixture_assignment.h"
#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "tests/benchmarks/checked_benchmark.h"
#include "tests/benchmarks/proxy_benchmark.h"

namespace remote_touch::benchmarks {
namespace {

constexpr double kRadius_m = 0.02;

PointCloud coloured_frame() {
  PointCloud cloud = naive::wave_image(0.5);
  // Reddish hues, which the rule selects, beside green ones, each in shades.
  for (std::uint32_t i = 0; i < cloud.size(); ++i)
    cloud.colour.push_back((i / 40 % 2 == 0 ? 0xC00000 : 0x00C000) + i % 64);
  return cloud;
}

using Picks = std::function<bool(const PointCloud&, std::size_t)>;

template <class Rule>
void add_rule(const std::string& name, const PointCloud& cloud, const Picks& picks,
              const typename Rule::Settings& settings = {}) {
  std::vector<std::unique_ptr<const FixtureRule>> rules;
  rules.push_back(std::make_unique<Rule>(settings));
  const auto assignment = std::make_shared<const FixtureAssignment>(std::move(rules));
  const auto is_right = [=, &cloud] {
    PointCloud frame = cloud;
    assignment->assign(frame, 0);
    for (std::size_t i = 0; i < frame.size(); ++i)
      if (frame.fixture_radius_m[i] != (picks(frame, i) ? kRadius_m : 0)) return false;
    return true;
  };
  add("fixture_assign/" + name, is_right, [=, &cloud](benchmark::State& state) {
    PointCloud frame = cloud;
    for (auto _ : state) {
      assignment->assign(frame, 0);
      benchmark::ClobberMemory();
      frame.fixture_radius_m = {};  // each frame comes without the column
    }
  });
}

void add_search(const std::string& name, const PointCloud& cloud, bool with_radius) {
  add("fixture_make_search/" + name, [&cloud, with_radius](benchmark::State& state) {
    std::unique_ptr<NeighbourSearch> search;
    for (auto _ : state) {
      state.PauseTiming();
      search.reset();
      PointCloud frame = cloud;
      if (with_radius) frame.fixture_radius_m.assign(frame.size(), kRadius_m);
      state.ResumeTiming();
      search = make_search(std::move(frame));
    }
  });
}

}  // namespace

void add_assignments() {
  static const PointCloud cloud = coloured_frame();
  add_rule<Everywhere>("everywhere", cloud, [](const PointCloud&, std::size_t) { return true; });
  add_rule<HalfSpace>("half-space", cloud,
                      [](const PointCloud& frame, std::size_t i) { return frame.x[i] >= 0; });
  NearPoint::Settings near;
  near.point_m = Vec3(0, 0, 0.5);
  add_rule<NearPoint>(
      "near-point", cloud,
      [near](const PointCloud& frame, std::size_t i) {
        return (frame.point(i) - near.point_m).norm() <= near.inner_radius_m;
      },
      near);
  add_rule<HueRange>("hue-range", cloud,
                     [](const PointCloud& frame, std::size_t i) { return frame.colour[i] >> 16 == 0xC0; });
  add_search("no_radius", cloud, false);
  add_search("radius", cloud, true);
}

}  // namespace remote_touch::benchmarks
