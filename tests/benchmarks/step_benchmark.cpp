// One proxy step: the plain method, a step on a list that exists already, a step with a search, and a step as
// the renderer does it.
#include <benchmark/benchmark.h>

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/dissertation/proxy/proxy_step.h"
#include "core/kernels/isa.h"
#include "core/search/neighbourhood.h"
#include "tests/benchmarks/checked_benchmark.h"
#include "tests/benchmarks/proxy_benchmark.h"

namespace remote_touch::benchmarks {
namespace {

bool same(const naive::Step& a, const naive::Step& b) {
  return a.state == b.state && std::abs(a.nearest_distance_m - b.nearest_distance_m) < 1e-15 &&
         (a.normal - b.normal).norm() < 1e-11 && (a.step - b.step).norm() < 1e-14;
}

// make_step() gives a functor from proxy and HIP to a naive::Step. Its listed() is the number of points that
// it read.
template <class MakeStep>
void add_step(const std::string& name, const Slide& slide, MakeStep make_step) {
  const auto is_right = [&slide, make_step] {
    auto step = make_step();
    for (std::size_t i = 0; i < slide.expected_steps.size(); ++i)
      if (!same(step(slide.proxies[i * kCheckEvery], slide.hips[i * kCheckEvery]), slide.expected_steps[i]))
        return false;
    return true;
  };
  add(name, is_right, [&slide, make_step](benchmark::State& state) {
    auto step = make_step();
    Vec3 last = Vec3::Zero();
    std::size_t i = 0, listed = 0;
    for (auto _ : state) {
      // A proxy step starts where the one before ended. Adding 0 times that step keeps the recorded position
      // and makes the processor wait for it, as it would have to.
      last = step(slide.proxies[i] + 0.0 * last, slide.hips[i]).step;
      if (++i == slide.proxies.size()) i = 0;
    }
    benchmark::DoNotOptimize(last);
    for (std::size_t k = 0; k < slide.proxies.size(); k += kCheckEvery)
      step(slide.proxies[k], slide.hips[k]), listed += step.listed();
    state.counters["within_r3"] = slide.within_r3;
    state.counters["listed"] = static_cast<double>(listed) / static_cast<double>(slide.expected_steps.size());
  });
}

struct NaiveStep {
  std::vector<Vec3> points;
  naive::Step operator()(const Vec3& proxy_W, const Vec3& hip_W) const {
    return naive::proxy_step(points, proxy_W, hip_W, Vec3::Zero(), kSettings);
  }
  std::size_t listed() const { return points.size(); }
};

// State, normal and contact step from a list of points, as ProxyRenderer::local_query() and next_step() make
// them.
naive::Step step_from(const GatheredPoints& list, double sum_grid, const Kernels& kernels,
                      const Vec3& proxy_W, const Vec3& hip_W) {
  const ProxyRegions regions{kSettings.r1_m, kSettings.r2_m, kSettings.r3_m, sum_grid,
                             kSettings.stiffness_N_per_m};
  const ContactQuery query = kernels.proxy.contact_query(list.view(), proxy_W.data(), regions);
  naive::Step out;
  out.nearest_distance_m = query.nearest;
  out.state = classify(query.nearest, kSettings);
  out.normal = unit_normal(query, Vec3::Zero());
  if (out.state == ContactState::contact) out.step = contact_step(out.normal, hip_W - proxy_W, kSettings);
  return out;
}

double sum_grid_for(const GatheredPoints& list) {
  return 1.5 * static_cast<double>(std::bit_ceil(list.size() + 1));
}

// The list exists already: the step alone is timed.
class ListedStep {
 public:
  ListedStep(const NeighbourSearch& search, const Vec3& proxy_W, const Kernels& kernels) : kernels_(kernels) {
    list_.reserve(search.size(), false, false);
    search.gather({proxy_W, kSettings.r3_m}, kernels, list_);
    list_.finish();
  }
  naive::Step operator()(const Vec3& proxy_W, const Vec3& hip_W) const {
    return step_from(list_, sum_grid_for(list_), kernels_, proxy_W, hip_W);
  }
  std::size_t listed() const { return list_.size(); }

 private:
  const Kernels& kernels_;
  GatheredPoints list_;
};

// The worst case: the points within r3 are gathered anew at every step.
class SearchedStep {
 public:
  SearchedStep(const NeighbourSearch& search, const Kernels& kernels) : search_(search), kernels_(kernels) {
    list_.reserve(search.size(), false, false);
  }
  naive::Step operator()(const Vec3& proxy_W, const Vec3& hip_W) {
    list_.clear();
    search_.gather({proxy_W, kSettings.r3_m}, kernels_, list_);
    list_.finish();
    return step_from(list_, sum_grid_for(list_), kernels_, proxy_W, hip_W);
  }
  std::size_t listed() const { return list_.size(); }

 private:
  const NeighbourSearch& search_;
  const Kernels& kernels_;
  GatheredPoints list_;
};

// Makes steps as the renderer does: the list of points is kept while the proxy stays near, and a narrower
// list is used while it moves slowly.
class KeptStep {
 public:
  KeptStep(std::shared_ptr<const NeighbourSearch> search, const Kernels& kernels)
      : kernels_(kernels), near_(kSettings.r3_m, kernels) {
    near_.set_points(std::move(search));
  }
  naive::Step operator()(const Vec3& proxy_W, const Vec3& hip_W) {
    const GatheredPoints& list = near_.narrowed(proxy_W);
    listed_ = list.size();
    return step_from(list, near_.sum_grid(), kernels_, proxy_W, hip_W);
  }
  std::size_t listed() const { return listed_; }

 private:
  const Kernels& kernels_;
  Neighbourhood near_;
  std::size_t listed_ = 0;
};

}  // namespace

void add_steps(const Slide& slide, const Slide& still) {
  add_step("step_naive/" + slide.name, slide, [&slide] { return NaiveStep{slide.points}; });
  add_step("step_naive_on_list/" + slide.name, still, [&still] {
    std::vector<Vec3> points;
    for (const std::uint32_t i : naive::points_within(still.cloud, {still.proxies[0], kSettings.r3_m}))
      points.push_back(still.points[i]);
    return NaiveStep{points};
  });
  for (const Kernels* kernels : supported_kernels()) {
    const std::string of = "/" + slide.name + "/" + kernels->isa;
    add_step("step_on_list" + of, still,
             [&still, kernels] { return ListedStep(*still.search, still.proxies[0], *kernels); });
    add_step("step_with_search" + of, slide,
             [&slide, kernels] { return SearchedStep(*slide.search, *kernels); });
    add_step("step_with_kept_list" + of, slide,
             [&slide, kernels] { return KeptStep(slide.search, *kernels); });
  }
}

}  // namespace remote_touch::benchmarks
