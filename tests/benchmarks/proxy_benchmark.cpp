// The proxy of chapter 4 on a flat grid of 100 x 100 points: one step with its search beside the plain method
// of naive_proxy.h, and whole ticks with fewer steps; and quadratic programs of six variables. Every
// benchmark compares its answers with a reference before it is timed, and is skipped with an error if they
// differ.
#include <benchmark/benchmark.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "core/dissertation/proxy/proxy_motion.h"
#include "core/dissertation/proxy/proxy_renderer.h"
#include "core/dissertation/tool_motion/motion_program.h"
#include "core/kernels/kernels.h"
#include "core/points/neighbour_search.h"
#include "tests/benchmarks/checked_benchmark.h"
#include "tests/benchmarks/naive_proxy.h"
#include "tests/core/dissertation/tool_motion/program_peers.h"
#include "tests/support/scenes.h"
#ifdef REMOTE_TOUCH_NLOPT
#include "tests/core/dissertation/tool_motion/nlopt_program.h"
#endif

namespace remote_touch::benchmarks {
namespace {

const ProxyParameters kSettings;
constexpr double kTickRate_hz = 1000;
constexpr std::size_t kSteps = 4096, kCheckEvery = 8, kCheckedTicks = 20;

// A HIP that starts above the grid, then jumps below it and slides at 0.1 m/s; and single steps in contact on
// its way.
struct Slide {
  PointCloud cloud = scenes::flat_grid(100);
  std::vector<Vec3> points = naive::points_of(cloud);
  std::shared_ptr<const NeighbourSearch> search = make_search(cloud);
  std::vector<Vec3> proxies = {}, hips = {};

  ProxyRenderer renderer(const ProxyParameters& parameters, double rate_hz, const Kernels& kernels) const {
    ProxyRenderer made(parameters, rate_hz, kernels);
    made.on_frame({0, 0, 0, search});
    made.step({above()}, 0);
    return made;
  }
  static Vec3 above() { return {-0.025, 0.02, 0}; }
  static Vec3 hip_at(double time_s) {
    return Vec3(-0.025, -0.005, 0) + 0.1 * time_s * Vec3(1, 0, 0.3).normalized();
  }
};

ProxyParameters stepping(double gamma, int steps_per_tick) {
  ProxyParameters p = kSettings;
  p.gamma = gamma, p.steps_per_tick = steps_per_tick;
  return p;
}

// The renderer itself finds the positions, at one proxy step per tick. The plain method then checks them.
Slide recorded() {
  Slide slide;
  const double rate_hz = kTickRate_hz * kSettings.steps_per_tick;
  ProxyRenderer renderer = slide.renderer(stepping(kSettings.gamma, 1), rate_hz, scenes::kernels());
  for (int i = 0; slide.proxies.size() < kSteps; ++i) {
    const double time_s = std::max(0, i - 1000) / rate_hz;  // the first steps go down to the surface
    const RenderOutput out = renderer.step({Slide::hip_at(time_s)}, i / rate_hz);
    if (i < 1000 || out.state != ContactState::contact) continue;
    slide.proxies.push_back(out.proxy_W);
    slide.hips.push_back(Slide::hip_at(time_s + 1 / rate_hz));
  }
  return slide;
}

// --- one step ---

struct NaiveStep {
  const std::vector<Vec3>& points;
  naive::Step operator()(const Vec3& proxy_W, const Vec3& hip_W) const {
    return naive::proxy_step(points, proxy_W, hip_W, Vec3::Zero(), kSettings);
  }
};

// Makes steps as the renderer does: the list of points is kept while the proxy stays near, and a narrower
// list is used while it moves slowly.
class KeptStep {
 public:
  KeptStep(const std::shared_ptr<const NeighbourSearch>& search, const Kernels& kernels)
      : kernels_(kernels), near_(kSettings.r3_m, kernels) {
    near_.set_points(search);
  }
  naive::Step operator()(const Vec3& proxy_W, const Vec3& hip_W) {
    const GatheredPoints& list = near_.narrowed(proxy_W);
    const ProxyRegions regions{kSettings.r1_m, kSettings.r2_m, kSettings.r3_m, near_.sum_grid(),
                               kSettings.stiffness_N_per_m};
    const ContactQuery query = kernels_.proxy.contact_query(list.view(), proxy_W.data(), regions);
    naive::Step out;
    out.nearest_distance_m = query.nearest;
    out.state = classify(query.nearest, kSettings);
    out.normal = unit_normal(query, Vec3::Zero());
    if (out.state == ContactState::contact) out.step = contact_step(out.normal, hip_W - proxy_W, kSettings);
    return out;
  }

 private:
  const Kernels& kernels_;
  Neighbourhood near_;
};

bool steps_agree(const Slide& slide, KeptStep step) {
  for (std::size_t i = 0; i < kSteps; i += kCheckEvery) {
    const naive::Step a = step(slide.proxies[i], slide.hips[i]),
                      b = NaiveStep{slide.points}(slide.proxies[i], slide.hips[i]);
    if (!(a.state == b.state && std::abs(a.nearest_distance_m - b.nearest_distance_m) < 1e-15 &&
          (a.normal - b.normal).norm() < 1e-11 && (a.step - b.step).norm() < 1e-14))
      return false;
  }
  return true;
}

template <class Step>
void time_steps(benchmark::State& state, const Slide& slide, Step step) {
  Vec3 last = Vec3::Zero();
  std::size_t i = 0;
  for (auto _ : state) {
    // A proxy step starts where the one before ended. Adding 0 times that step keeps the recorded position
    // and makes the processor wait for it, as it would have to.
    last = step(slide.proxies[i] + 0.0 * last, slide.hips[i]).step;
    if (++i == kSteps) i = 0;
  }
  benchmark::DoNotOptimize(last);
}

// --- whole ticks ---

// A plain tick ends early as the renderer's does, when nothing moves any more.
bool ticks_agree(const Slide& slide, const Kernels& kernels) {
  ProxyRenderer renderer = slide.renderer(kSettings, kTickRate_hz, kernels);
  Vec3 proxy_W = Slide::above(), normal_W = Vec3::Zero();
  for (std::size_t i = 1; i < kCheckedTicks; ++i) {
    const double time_s = i / kTickRate_hz;
    const Vec3 hip_W = Slide::hip_at(time_s);
    for (int k = 0; k < kSettings.steps_per_tick; ++k) {
      const naive::Step step = naive::proxy_step(slide.points, proxy_W, hip_W, normal_W, kSettings);
      normal_W = step.normal;
      if (proxy_W + step.step == proxy_W) break;
      proxy_W += step.step;
    }
    if ((renderer.step({hip_W}, time_s).proxy_W - proxy_W).norm() > 1e-9) return false;
  }
  return true;
}

// Returns the position where the proxy rests after a slide of 20 mm.
Vec3 rest_of(const Slide& slide, const ProxyParameters& parameters, const Kernels& kernels) {
  constexpr int kSlideTicks = 200, kRestTicks = 40;
  ProxyRenderer renderer = slide.renderer(parameters, kTickRate_hz, kernels);
  RenderOutput out;
  for (int tick = 0; tick < kSlideTicks + kRestTicks; ++tick)
    out = renderer.step({Slide::hip_at(std::min(tick, kSlideTicks) / kTickRate_hz)}, 0);
  return out.proxy_W;
}

// The rest position may depend on the way to it, by as much as the contact region is thick.
bool rests_agree(const Slide& slide, const ProxyParameters& parameters, const Kernels& kernels) {
  const Vec3 limit_W = rest_of(slide, stepping(kSettings.gamma, 1000), kernels);
  return (rest_of(slide, parameters, kernels) - limit_W).norm() < parameters.r2_m - parameters.r1_m;
}

void time_ticks(benchmark::State& state, const Slide& slide, const ProxyParameters& parameters,
                const Kernels& kernels) {
  constexpr int kTicksOneWay = 500;
  ProxyRenderer renderer = slide.renderer(parameters, kTickRate_hz, kernels);
  for (int i = 0; i < 10; ++i) renderer.step({Slide::hip_at(0)}, 0);  // down to the surface
  int tick = 0, displacement = 1;
  for (auto _ : state) {
    benchmark::DoNotOptimize(renderer.step({Slide::hip_at(tick / kTickRate_hz)}, 0).steps);
    tick += displacement;
    if (tick == 0 || tick == kTicksOneWay) displacement = -displacement;
  }
}

// --- quadratic programs of six variables, and the same by NLopt; the answers are first compared with those
// of least distance programming ---

using Problem = peers::Problem<6>;
using Vector = peers::Vector<6>;

// The programs are many, in turn, so that the processor cannot learn their branches.
constexpr int kProblems = 64;

// Random rows around a point near the origin that fulfils them, and a random target.
struct Problems {
  std::vector<Problem> all;
  std::vector<QuadraticProgram<6>> programs;
  std::vector<Vector> answers;

  explicit Problems(int rows) {
    std::mt19937_64 random(static_cast<unsigned>(rows));
    std::normal_distribution<double> normal;
    const auto vector = [&] { return Vector(Vector::NullaryExpr([&] { return normal(random); })); };
    for (int i = 0; i < kProblems; ++i) {
      Problem problem;
      problem.target = vector();
      for (int j = 0; j < rows; ++j) {
        const Vector row = vector();
        problem.add(row, -0.5 * std::abs(normal(random)));
      }
      programs.push_back(problem.program());
      answers.push_back(peers::min_distance(problem).y);
      all.push_back(problem);
    }
  }

  template <class Solve>
  bool agree(const Solve& solve, double tolerance) const {
    for (std::size_t i = 0; i < all.size(); ++i)
      if (!((solve(i) - answers[i]).norm() < tolerance)) return false;
    return true;
  }
};

template <class Solve>
void add_solver(const std::string& name, const std::shared_ptr<const Problems>& problems, double tolerance,
                const Solve& solve) {
  add(
      name, [=] { return problems->agree([&](std::size_t i) { return solve(*problems, i); }, tolerance); },
      [=](benchmark::State& state) {
        std::size_t i = 0;
        for (auto _ : state) {
          benchmark::DoNotOptimize(solve(*problems, i));
          i = (i + 1) % kProblems;
        }
      });
}

void add_programs() {
  for (const int rows : {6, 50}) {
    const auto problems = std::make_shared<const Problems>(rows);
    const std::string count = std::to_string(rows);
    add_solver("program_ours/" + count, problems, 1e-10,
               [](const Problems& p, std::size_t i) { return p.programs[i].nearest(p.all[i].target).y; });
#ifdef REMOTE_TOUCH_NLOPT
    add_solver("program_nlopt/" + count, problems, 1e-6,
               [](const Problems& p, std::size_t i) { return peers::nlopt_nearest(p.all[i]); });
#endif
  }
}

}  // namespace
}  // namespace remote_touch::benchmarks

int main(int argc, char** argv) {
  using namespace remote_touch;
  using namespace remote_touch::benchmarks;
  const Slide slide = recorded();
  add("step_naive", [&](benchmark::State& state) { time_steps(state, slide, NaiveStep{slide.points}); });
  for (const Kernels* kernels : supported_kernels()) {
    const std::string of = std::string("/") + kernels->isa;
    add(
        "step" + of,
        [&slide, kernels] {
          return steps_agree(slide, {slide.search, *kernels});
        },
        [&slide, kernels](benchmark::State& state) {
          time_steps(state, slide, KeptStep(slide.search, *kernels));
        });
    add(
        "tick_of_30_steps" + of, [&slide, kernels] { return ticks_agree(slide, *kernels); },
        [&slide, kernels](benchmark::State& state) { time_ticks(state, slide, kSettings, *kernels); });
    for (const ProxyParameters& fewer : {stepping(0.3, 10), stepping(0.5, 8)})
      add(
          "tick_of_" + std::to_string(fewer.steps_per_tick) + "_steps" + of,
          [&slide, fewer, kernels] { return rests_agree(slide, fewer, *kernels); },
          [&slide, fewer, kernels](benchmark::State& state) { time_ticks(state, slide, fewer, *kernels); });
  }
  add_programs();
  return run_benchmarks(argc, argv);
}
