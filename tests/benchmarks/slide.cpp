#include "tests/benchmarks/slide.h"

#include <algorithm>

#include "core/dissertation/proxy/proxy_renderer.h"
#include "tests/support/scenes.h"

namespace remote_touch::benchmarks {
namespace {

constexpr double kSpeed_m_per_s = 0.1;
constexpr std::size_t kSteps = 4096;

// The renderer itself finds the positions, at one proxy step per tick. The plain method then checks them.
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

// A whole tick, plainly. It ends early as the renderer's does, when nothing moves any more.
void naive_tick(const Slide& slide, const Vec3& hip_W, Vec3& proxy_W, Vec3& normal_W) {
  for (int k = 0; k < kSettings.steps_per_tick; ++k) {
    const naive::Step step = naive::proxy_step(slide.points, proxy_W, hip_W, normal_W, kSettings);
    normal_W = step.normal;
    if (proxy_W + step.step == proxy_W) return;
    proxy_W += step.step;
  }
}

}  // namespace

Vec3 hip_at(const Slide& slide, double time_s) {
  return slide.start + kSpeed_m_per_s * time_s * slide.direction;
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

Slide stopped(const Slide& slide) {
  Slide still = slide;
  still.proxies.resize(1), still.hips.resize(1), still.expected_steps.resize(1);
  still.within_r3 = within_r3(still);
  return still;
}

}  // namespace remote_touch::benchmarks
