// Times of the proxy and of its parts, in nanoseconds. Every benchmark compares its answers with the plain
// ones of naive_proxy.h before it is timed, and is skipped with an error when they differ. Times mean
// something as ratios within one run; scripts/benchmark prints those.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/proxy_renderer.h"
#include "core/proxy_step.h"
#include "scenarios/recording.h"
#include "tests/benchmarks/naive_proxy.h"
#include "tests/scenes.h"

namespace remote_touch {
namespace {

const ProxyParameters kSettings;
constexpr double kSpeed_m_per_s = 0.1;
constexpr double kTickRate_hz = 1000;

bool mismatch = false;

std::vector<const Kernels*> levels() {
  std::vector<const Kernels*> all;
  for (const Isa isa : {Isa::x86_64, Isa::x86_64_v3, Isa::x86_64_v4})
    if (isa <= best_isa()) all.push_back(&kernels_for(isa));
  return all;
}

// Checked once a process: repetitions and calibration run the same code on the same data.
void add(const std::string& name, const std::function<bool()>& is_right,
         const std::function<void(benchmark::State&)>& time) {
  const auto checked = std::make_shared<bool>(false);
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
    if (!*checked && !is_right()) {
      mismatch = true;
      state.SkipWithError("the answers differ from the reference");
      return;
    }
    *checked = true;
    time(state);
  });
}

// --- a slide over a surface ---

// A cloud, and a HIP that slides below its surface at kSpeed_m_per_s.
struct Slide {
  std::string name;
  PointCloud cloud;
  Vec3 above, start, direction;  // of the HIP; it starts above the surface, then jumps to start
  std::shared_ptr<const NeighbourSearch> search = nullptr;
  std::vector<Vec3> points = {};                 // the cloud as the plain method reads it
  std::vector<Vec3> proxies = {}, hips = {};     // single steps in contact state
  std::vector<naive::Step> expected_steps = {};  // of every kCheckEvery-th
  std::vector<Vec3> expected_ticks = {};         // proxies after whole ticks
  double within_r3 = 0;                          // points within r3 of a proxy, on average
};

constexpr std::size_t kSteps = 4096, kCheckEvery = 8, kCheckedTicks = 20;

Vec3 hip_at(const Slide& slide, double time_s) {
  return slide.start + kSpeed_m_per_s * time_s * slide.direction;
}

// The renderer itself finds the positions, at one proxy step a tick; the plain method then says whether they
// are right.
void record_steps(Slide& slide) {
  ProxyParameters one_step = kSettings;
  one_step.steps_per_tick = 1;
  const double rate_hz = kTickRate_hz * kSettings.steps_per_tick;
  ProxyRenderer renderer(one_step, rate_hz, scenes::kernels());
  renderer.on_frame({0, 0, 0, slide.search});
  renderer.step({slide.above}, 0);
  for (int i = 0; slide.proxies.size() < kSteps; ++i) {
    const double time_s = std::max(0, i - 1000) / rate_hz;  // the first steps go down to the surface
    const RenderOutput out = renderer.step({hip_at(slide, time_s)}, i / rate_hz);
    if (i < 1000 || out.state != ContactState::contact) continue;
    slide.proxies.push_back(out.proxy_W);
    slide.hips.push_back(hip_at(slide, time_s + 1 / rate_hz));
  }
}

double within_r3(const Slide& slide) {
  double sum = 0;
  for (std::size_t i = 0; i < slide.expected_steps.size(); ++i)
    sum += static_cast<double>(
        naive::points_within(slide.cloud, {slide.proxies[i * kCheckEvery], kSettings.r3_m}).size());
  return sum / static_cast<double>(slide.expected_steps.size());
}

// A whole tick, plainly; ends early like the renderer's, when nothing moves any more.
void naive_tick(const Slide& slide, const Vec3& hip_W, Vec3& proxy_W, Vec3& normal_W) {
  for (int k = 0; k < kSettings.steps_per_tick; ++k) {
    const naive::Step step = naive::proxy_step(slide.points, proxy_W, hip_W, normal_W, kSettings);
    normal_W = step.normal;
    if (proxy_W + step.step == proxy_W) return;
    proxy_W += step.step;
  }
}

Slide made(Slide slide) {
  slide.points = naive::points_of(slide.cloud);
  slide.search = make_search(slide.cloud);
  record_steps(slide);
  for (std::size_t i = 0; i < kSteps; i += kCheckEvery)
    slide.expected_steps.push_back(
        naive::proxy_step(slide.points, slide.proxies[i], slide.hips[i], Vec3::Zero(), kSettings));
  slide.within_r3 = within_r3(slide);
  Vec3 proxy_W = slide.above, normal_W = Vec3::Zero();
  for (std::size_t i = 0; i < kCheckedTicks; ++i) {
    if (i > 0) naive_tick(slide, hip_at(slide, i / kTickRate_hz), proxy_W, normal_W);
    slide.expected_ticks.push_back(proxy_W);
  }
  return slide;
}

// --- one proxy step ---

bool same(const naive::Step& a, const naive::Step& b) {
  return a.state == b.state && std::abs(a.nearest_m - b.nearest_m) < 1e-15 &&
         (a.normal - b.normal).norm() < 1e-11 && (a.step - b.step).norm() < 1e-14;
}

// make_step() gives a functor from proxy and HIP to a naive::Step; its listed() is the number of points it
// read.
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

// State, normal and contact step from a list of points, as ProxyRenderer::look() and next_step() make them.
naive::Step step_from(const GatheredPoints& list, double sum_grid, const Kernels& kernels,
                      const Vec3& proxy_W, const Vec3& hip_W) {
  const ProxyRegions regions{kSettings.r1_m, kSettings.r2_m, kSettings.r3_m, sum_grid};
  const Survey survey = kernels.survey(list.view(), proxy_W.data(), regions);
  naive::Step out;
  out.nearest_m = survey.nearest;
  out.state = classify(survey.nearest, kSettings);
  out.normal = unit_normal(survey, Vec3::Zero());
  if (out.state == ContactState::contact) out.step = contact_step(out.normal, hip_W - proxy_W, kSettings);
  return out;
}

double sum_grid_for(const GatheredPoints& list) {
  return 1.5 * static_cast<double>(std::bit_ceil(list.size() + 1));
}

// The list is there already: the step alone.
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

// As the renderer steps: the list is kept while the proxy stays near.
class KeptStep {
 public:
  KeptStep(std::shared_ptr<const NeighbourSearch> search, const Kernels& kernels)
      : kernels_(kernels), near_(kSettings.r3_m, kernels) {
    near_.set_points(std::move(search));
  }
  naive::Step operator()(const Vec3& proxy_W, const Vec3& hip_W) {
    const GatheredPoints& list = near_.around(proxy_W);
    listed_ = list.size();
    return step_from(list, near_.sum_grid(), kernels_, proxy_W, hip_W);
  }
  std::size_t listed() const { return listed_; }

 private:
  const Kernels& kernels_;
  Neighbourhood near_;
  std::size_t listed_ = 0;
};

// The slide stopped at its first step, so that one list serves.
Slide stopped(const Slide& slide) {
  Slide still = slide;
  still.proxies.resize(1), still.hips.resize(1), still.expected_steps.resize(1);
  still.within_r3 = within_r3(still);
  return still;
}

void add_steps(const Slide& slide, const Slide& still) {
  add_step("step_naive/" + slide.name, slide, [&slide] { return NaiveStep{slide.points}; });
  add_step("step_naive_on_list/" + slide.name, still, [&still] {
    std::vector<Vec3> points;
    for (const std::uint32_t i : naive::points_within(still.cloud, {still.proxies[0], kSettings.r3_m}))
      points.push_back(still.points[i]);
    return NaiveStep{points};
  });
  for (const Kernels* kernels : levels()) {
    const std::string of = "/" + slide.name + "/" + kernels->isa;
    add_step("step_on_list" + of, still,
             [&still, kernels] { return ListedStep(*still.search, still.proxies[0], *kernels); });
    add_step("step_with_search" + of, slide,
             [&slide, kernels] { return SearchedStep(*slide.search, *kernels); });
    add_step("step_with_kept_list" + of, slide,
             [&slide, kernels] { return KeptStep(slide.search, *kernels); });
  }
}

// --- whole ticks of the renderer ---

bool ticks_agree(const Slide& slide, const Kernels& kernels) {
  ProxyRenderer renderer(kSettings, kTickRate_hz, kernels);
  renderer.on_frame({0, 0, 0, slide.search});
  for (std::size_t i = 0; i < kCheckedTicks; ++i) {
    const double time_s = i / kTickRate_hz;
    const Vec3 hip_W = i == 0 ? slide.above : hip_at(slide, time_s);
    if ((renderer.step({hip_W}, time_s).proxy_W - slide.expected_ticks[i]).norm() > 1e-9) return false;
  }
  return true;
}

void time_ticks(benchmark::State& state, const Slide& slide, const Kernels& kernels) {
  constexpr int kTicksOneWay = 500;
  ProxyRenderer renderer(kSettings, kTickRate_hz, kernels);
  renderer.on_frame({0, 0, 0, slide.search});
  renderer.step({slide.above}, 0);
  for (int i = 0; i < 10; ++i) renderer.step({slide.start}, 0);  // down to the surface
  int tick = 0, way = 1;
  double steps = 0, in_contact = 0;
  for (auto _ : state) {
    const RenderOutput out = renderer.step({hip_at(slide, tick / kTickRate_hz)}, 0);
    steps += out.steps;
    in_contact += out.state == ContactState::contact ? 1 : 0;
    tick += way;
    if (tick == 0 || tick == kTicksOneWay) way = -way;
  }
  using Counter = benchmark::Counter;
  state.counters["steps"] = Counter(steps, Counter::kAvgIterations);
  state.counters["in_contact"] = Counter(in_contact, Counter::kAvgIterations);
  state.counters["s_per_step"] = Counter(steps, Counter::kIsRate | Counter::kInvert);
}

void add_ticks(const Slide& slide) {
  for (const Kernels* kernels : levels())
    add(
        "tick/" + slide.name + "/" + kernels->isa, [&slide, kernels] { return ticks_agree(slide, *kernels); },
        [&slide, kernels](benchmark::State& state) { time_ticks(state, slide, *kernels); });
}

// --- radius queries ---

bool finds_expected(const NeighbourSearch& search, const naive::Queries& queries, const Kernels& kernels) {
  GatheredPoints list;
  list.reserve(search.size(), false, false);
  for (std::size_t i = 0; i < queries.balls.size(); ++i) {
    list.clear();
    search.gather(queries.balls[i], kernels, list);
    std::vector<std::uint32_t> found(list.index(), list.index() + list.size());
    std::sort(found.begin(), found.end());
    if (found != queries.expected[i]) return false;
  }
  return true;
}

void time_queries(benchmark::State& state, const NeighbourSearch& search, const naive::Queries& queries,
                  const Kernels& kernels) {
  GatheredPoints list;
  list.reserve(search.size(), false, false);
  std::size_t i = 0;
  double found = 0;
  for (auto _ : state) {
    list.clear();
    search.gather(queries.balls[i], kernels, list);
    list.finish();
    benchmark::ClobberMemory();
    found += static_cast<double>(list.size());
    if (++i == queries.balls.size()) i = 0;
  }
  state.counters["found"] = benchmark::Counter(found, benchmark::Counter::kAvgIterations);
}

void add_query(const std::string& name, const std::shared_ptr<const NeighbourSearch>& search,
               const naive::Queries& queries) {
  for (const Kernels* kernels : levels())
    add(
        name + "/" + queries.name + "/" + kernels->isa,
        [=, &queries] { return finds_expected(*search, queries, *kernels); },
        [=, &queries](benchmark::State& state) { time_queries(state, *search, queries, *kernels); });
}

void add_queries(const naive::Queries& queries) {
  add_query("query_brute_force", std::make_shared<BruteForceSearch>(queries.cloud), queries);
  add_query("query_cells", std::make_shared<UniformGridSearch>(queries.cloud, 0.004), queries);
  if (queries.cloud.image)
    add_query("query_window", std::make_shared<ImageWindowSearch>(queries.cloud), queries);
}

// The first frame of a recording, where there is one: a real surface, with holes.
std::optional<PointCloud> recorded_cloud() {
  const char* named = std::getenv("REMOTE_TOUCH_DATA");
  const auto folder =
      std::filesystem::path(named != nullptr ? named : "../shared/data") / "rgbd/visp_organ_table";
  if (!std::filesystem::exists(folder)) return std::nullopt;
  return read_frame(index_recording(folder), 0, 3.0);
}

// --- noise ---

constexpr std::size_t kNoisyPoints = 4096;
constexpr NoiseStream kStream{{1, 2}, {3, 4, 5}};

// Philox4x32-10 and Box-Muller with the standard library's functions: the three normals of one point.
Vec3 plain_normals(std::uint32_t point) {
  std::uint32_t c[4] = {point, kStream.counter[0], kStream.counter[1], kStream.counter[2]};
  std::uint32_t key[2] = {kStream.key[0], kStream.key[1]};
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t left = std::uint64_t{0xD2511F53} * c[0], right = std::uint64_t{0xCD9E8D57} * c[2];
    c[0] = static_cast<std::uint32_t>(right >> 32) ^ c[1] ^ key[0];
    c[2] = static_cast<std::uint32_t>(left >> 32) ^ c[3] ^ key[1];
    c[1] = static_cast<std::uint32_t>(right), c[3] = static_cast<std::uint32_t>(left);
    key[0] += 0x9E3779B9, key[1] += 0xBB67AE85;
  }
  const auto radius = [](std::uint32_t k) { return std::sqrt(-2 * std::log((k + 1.0) / 4294967296.0)); };
  const auto angle = [](std::uint32_t k) { return 2 * std::acos(-1.0) * (k / 4294967296.0); };
  return {radius(c[0]) * std::cos(angle(c[1])), radius(c[0]) * std::sin(angle(c[1])),
          radius(c[2]) * std::cos(angle(c[3]))};
}

struct Noise {
  std::vector<std::uint32_t> index;
  std::vector<double> x, y, z;
  Noise() : index(kNoisyPoints), x(kNoisyPoints), y(kNoisyPoints), z(kNoisyPoints) {
    for (std::size_t i = 0; i < kNoisyPoints; ++i) index[i] = static_cast<std::uint32_t>(7 * i);
  }
  void make(const Kernels& kernels) {
    kernels.normals(kStream, index.data(), kNoisyPoints, x.data(), y.data(), z.data());
  }
};

bool normals_agree(const Kernels& kernels) {
  Noise noise;
  noise.make(kernels);
  for (std::size_t i = 0; i < kNoisyPoints; ++i) {
    const Vec3 made(noise.x[i], noise.y[i], noise.z[i]);
    if (!((made - plain_normals(noise.index[i])).norm() < 1e-13)) return false;
  }
  return true;
}

void count_normals(benchmark::State& state) {
  using Counter = benchmark::Counter;
  state.counters["s_per_normal"] =
      Counter(3.0 * kNoisyPoints, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

void time_standard_normals(benchmark::State& state) {
  Noise noise;
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (auto _ : state) {
    for (std::size_t i = 0; i < kNoisyPoints; ++i)
      noise.x[i] = normal(random), noise.y[i] = normal(random), noise.z[i] = normal(random);
    benchmark::ClobberMemory();
  }
  count_normals(state);
}

void add_normals() {
  add(
      "normals_standard_library", [] { return true; }, time_standard_normals);
  for (const Kernels* kernels : levels())
    add(
        std::string("normals/") + kernels->isa, [kernels] { return normals_agree(*kernels); },
        [kernels](benchmark::State& state) {
          Noise noise;
          for (auto _ : state) {
            noise.make(*kernels);
            benchmark::ClobberMemory();
          }
          count_normals(state);
        });
}

}  // namespace
}  // namespace remote_touch

int main(int argc, char** argv) {
  using namespace remote_touch;
  const Slide grid = made({"grid", scenes::flat_grid(100), Vec3(-0.025, 0.02, 0), Vec3(-0.025, -0.005, 0),
                           Vec3(1, 0, 0.3).normalized()});
  const Slide image = made({"image", naive::wave_image(0.75), Vec3(-0.025, 0, 0.7), Vec3(-0.025, 0, 0.775),
                            Vec3(1, 0.3, 0).normalized()});
  const Slide grid_stopped = stopped(grid), image_stopped = stopped(image);
  add_steps(grid, grid_stopped);
  add_steps(image, image_stopped);
  add_ticks(grid);
  add_ticks(image);

  // At 1.03 m a 1 cm ball holds 81 pixels, as in the published comparison.
  std::vector<naive::Queries> queries;
  const std::optional<PointCloud> recorded = recorded_cloud();
  for (const naive::Centres centres : {naive::Centres::slide, naive::Centres::jump}) {
    queries.push_back(naive::on_grid(centres));
    queries.push_back(naive::on_image("image_0.75m", naive::wave_image(0.75), centres));
    queries.push_back(naive::on_image("image_1.03m", naive::wave_image(1.03), centres));
    if (recorded) queries.push_back(naive::on_image("image_recorded", *recorded, centres));
  }
  for (const naive::Queries& each : queries) add_queries(each);
  add_normals();

  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return mismatch ? 1 : 0;
}
