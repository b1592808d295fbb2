// The renderers proxy and tracked-sheet on the same lifts, 4.3.2, from no noise to 3 contact radii: the CPU
// time of a frame and of a tick while the HIP presses. Three things are checked before anything is timed.
// Every output is the same on all instruction set levels, bit for bit. The outputs of the tracked sheet
// without noise are the proxy's, on a cloud at rest bit for bit. The sheet ends above the cloud with the
// noise that it must withstand.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

#include "core/beyond/tracked_surface/tracked_sheet_renderer.h"
#include "core/kernels/isa.h"
#include "scenarios/synthetic/lifts.h"
#include "tests/benchmarks/checked_benchmark.h"

namespace remote_touch::benchmarks {
namespace {

constexpr double kRc_m = 0.005;  // r_c, as the renderers have it by default
constexpr int kFrameRate_hz = 30, kTickRate_hz = 1000;
constexpr int kFrames = 26;
constexpr int kPressFrame = 15;  // first frame with the HIP below the cloud
constexpr double kPressDepth_m = 0.03;
constexpr int kFirstTimedFrame = 2;         // the two frames before begin a track
constexpr double kStandsNoise_rc = 2;       // largest noise at which the sheet may not pop through
constexpr double kMinHeight_rc = -0.5;      // least height of its last proxy above the cloud
constexpr double kMotionStep_rc = 0x1p-12;  // grid of positions in core/beyond/tracked_surface/height_map.h

// --- a lift, and the answers on it ---

struct Lift {
  double noise_rc;
  MovingLift motion;
  std::vector<std::shared_ptr<const NeighbourSearch>> points;  // one per frame
};

Lift made(double noise_rc, MovingLift::Settings settings) {
  settings.noise_sigma_m = noise_rc * kRc_m;
  Lift lift{noise_rc, MovingLift(settings, NoiseKey{5}, kernels_for(best_isa())), {}};
  for (int f = 0; f < kFrames; ++f) lift.points.push_back(make_search(lift.motion.cloud(f)));
  return lift;
}

Lift lift_with_noise(double noise_rc) {
  MovingLift::Settings settings;
  settings.lift.acceleration_m_per_s2 = 1.5;
  return made(noise_rc, settings);
}

Lift cloud_at_rest() {
  MovingLift::Settings settings;
  settings.lift.start_velocity_m_per_s = settings.lift.acceleration_m_per_s2 = 0;
  return made(0, settings);
}

double time_of(int tick) {
  return static_cast<double>(tick) / kTickRate_hz;
}

// Returns the first tick that is not before the frame.
int first_tick_of(int frame) {
  return (frame * kTickRate_hz + kFrameRate_hz - 1) / kFrameRate_hz;
}

Frame frame_of(const Lift& lift, int f) {
  const double time_s = static_cast<double>(f) / kFrameRate_hz;
  return {f, time_s, time_s, lift.points[static_cast<std::size_t>(f)]};
}

// The device rests until the next frame.
DeviceState device_at(const Lift& lift, int f) {
  if (f < kPressFrame) return {Vec3::Zero()};
  return {Vec3(0, lift.motion.surface_height(0, 0, frame_of(lift, f).captured_s) - kPressDepth_m, 0)};
}

struct Method {
  std::string name;
  std::unique_ptr<Renderer> (*renderer)(const Kernels& kernels);
};

const Method kProxy{"proxy", [](const Kernels& kernels) -> std::unique_ptr<Renderer> {
                      return std::make_unique<ProxyRenderer>(ProxyParameters{}, kTickRate_hz, kernels);
                    }};
const Method kSheet{"tracked-sheet", [](const Kernels& kernels) -> std::unique_ptr<Renderer> {
                      return std::make_unique<TrackedSheetRenderer>(TrackedSheetParameters{}, kTickRate_hz,
                                                                    kernels);
                    }};

std::vector<RenderOutput> answers(const Lift& lift, const Method& method, const Kernels& kernels) {
  std::vector<RenderOutput> outputs;
  const std::unique_ptr<Renderer> renderer = method.renderer(kernels);
  for (int f = 0; f < kFrames; ++f) {
    renderer->on_frame(frame_of(lift, f));
    for (int tick = first_tick_of(f); tick < first_tick_of(f + 1); ++tick)
      outputs.push_back(renderer->step(device_at(lift, f), time_of(tick)));
  }
  return outputs;
}

// --- checks ---

std::uint64_t bits(double x) {
  return std::bit_cast<std::uint64_t>(x);
}
std::array<std::uint64_t, 3> bits(const Vec3& v) {
  return {bits(v.x()), bits(v.y()), bits(v.z())};
}
// Names every member, so that a new member does not compile until it is compared, too.
auto bits(const RenderOutput& out) {
  const auto& [proxy, force, slave, state, normal, velocity, nearest, frame_correction, steps, converged,
               contacts, frame, status, tool, guidance] = out;
  return std::tuple(bits(proxy), bits(force), bits(slave), state, bits(normal), bits(velocity), bits(nearest),
                    bits(frame_correction), steps, converged, contacts, frame, status, tool.has_value(),
                    guidance.has_value());
}

bool same_bits(const std::vector<RenderOutput>& a, const std::vector<RenderOutput>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const RenderOutput& p, const RenderOutput& q) { return bits(p) == bits(q); });
}

bool levels_agree(const Lift& lift, const Method& method) {
  const std::vector<RenderOutput> slowest = answers(lift, method, kernels_for(Isa::x86_64));
  const auto agrees = [&](const Kernels* level) { return same_bits(answers(lift, method, *level), slowest); };
  const auto all = supported_kernels();
  return std::all_of(all.begin(), all.end(), agrees);
}

bool proxy_right(const Lift& lift) {
  return levels_agree(lift, kProxy);
}

std::vector<RenderOutput> best_answers(const Lift& lift, const Method& method) {
  return answers(lift, method, kernels_for(best_isa()));
}

// The answers agree only nearly while the cloud moves: the sheet measures its motion in steps of
// kMotionStep_rc, and does so already before the touch.
bool nearly_same(const RenderOutput& p, const RenderOutput& q) {
  return (p.proxy_W - q.proxy_W).norm() < kMotionStep_rc * kRc_m && p.state == q.state &&
         p.contact_count == q.contact_count && p.frame_index == q.frame_index && p.status == q.status;
}

bool is_the_proxy_without_noise(const Lift& lift) {
  const Lift at_rest = cloud_at_rest();
  const std::vector<RenderOutput> proxy = best_answers(lift, kProxy), sheet = best_answers(lift, kSheet);
  return same_bits(best_answers(at_rest, kSheet), best_answers(at_rest, kProxy)) &&
         std::equal(sheet.begin(), sheet.end(), proxy.begin(), proxy.end(), nearly_same);
}

bool ends_above(const Lift& lift) {
  const Vec3 proxy_W = best_answers(lift, kSheet).back().proxy_W;
  const double end_s = time_of(first_tick_of(kFrames) - 1);
  return lift.motion.signed_distance(proxy_W, end_s) > kMinHeight_rc * kRc_m;
}

bool sheet_right(const Lift& lift) {
  return levels_agree(lift, kSheet) && (lift.noise_rc > 0 || is_the_proxy_without_noise(lift)) &&
         (lift.noise_rc > kStandsNoise_rc || ends_above(lift));
}

// --- times ---

// The times of each frame, and of all ticks between it and the next frame. They are kept from one repetition
// to the next.
struct LiftTimes {
  LeastTimes frames{kFrames}, ticks{kFrames};
};

void time_lift(const Lift& lift, Renderer& renderer, LiftTimes& least) {
  for (int f = 0; f < kFrames; ++f) {
    const Frame frame = frame_of(lift, f);
    const DeviceState device = device_at(lift, f);
    least.frames.time(f, [&] { renderer.on_frame(frame); });
    least.ticks.time(f, [&] {
      for (int tick = first_tick_of(f); tick < first_tick_of(f + 1); ++tick) {
        const RenderOutput out = renderer.step(device, time_of(tick));
        benchmark::DoNotOptimize(&out);
      }
    });
  }
}

// Counts the work of the ticks whose time is reported.
void count_work(benchmark::State& state, const std::vector<RenderOutput>& outputs) {
  double steps = 0, in_contact = 0;
  const auto first = static_cast<std::size_t>(first_tick_of(kPressFrame));
  for (std::size_t i = first; i < outputs.size(); ++i) {
    steps += outputs[i].steps;
    in_contact += outputs[i].state == ContactState::contact ? 1 : 0;
  }
  const auto ticks = static_cast<double>(outputs.size() - first);
  state.counters["steps"] = steps / ticks;
  state.counters["in_contact"] = in_contact / ticks;
}

void time_lifts(benchmark::State& state, const Lift& lift, const Method& method, LiftTimes& least) {
  const Kernels& kernels = kernels_for(best_isa());
  for (auto _ : state) {
    state.PauseTiming();
    const std::unique_ptr<Renderer> renderer = method.renderer(kernels);
    state.ResumeTiming();
    time_lift(lift, *renderer, least);
  }
  const auto sum = [](const auto& ns, int first) {
    return std::accumulate(ns.begin() + first, ns.end(), 0.0);
  };
  const int ticks = first_tick_of(kFrames) - first_tick_of(kPressFrame);
  state.counters["frame_ns"] = sum(least.frames.ns, kFirstTimedFrame) / (kFrames - kFirstTimedFrame);
  state.counters["tick_ns"] = sum(least.ticks.ns, kPressFrame) / ticks;
  count_work(state, answers(lift, method, kernels));
}

void add_lift(const std::shared_ptr<const Lift>& lift, const Method& method, bool (*is_right)(const Lift&)) {
  char noise[16];
  std::snprintf(noise, sizeof noise, "%g", lift->noise_rc);
  const auto least = std::make_shared<LiftTimes>();
  add(
      "sheet_lift/" + method.name + "/" + noise + "/" + kernels_for(best_isa()).isa,
      [=] { return is_right(*lift); },
      [=, &method](benchmark::State& state) { time_lifts(state, *lift, method, *least); });
}

}  // namespace
}  // namespace remote_touch::benchmarks

int main(int argc, char** argv) {
  using namespace remote_touch::benchmarks;
  for (const double noise_rc : {0.0, 0.2, 0.6, 1.0, 2.0, 3.0}) {
    const auto lift = std::make_shared<const Lift>(lift_with_noise(noise_rc));
    add_lift(lift, kProxy, proxy_right);
    add_lift(lift, kSheet, sheet_right);
  }
  return run_benchmarks(argc, argv);
}
