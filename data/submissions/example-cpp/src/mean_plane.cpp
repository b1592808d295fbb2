// A renderer in C++: a spring out of the mean height of the points of a frame.
#include <runners/interfaces/plugins/remote_touch_plugin.h>

#include <cmath>
#include <new>

namespace {

class MeanPlane {
 public:
  void take(const remote_touch_frame& frame) {
    double sum_m = 0;
    std::size_t measured = 0;
    for (std::size_t i = 0; i < frame.points; ++i)
      if (std::isfinite(frame.y[i])) sum_m += frame.y[i], ++measured;
    height_m_ = measured > 0 ? sum_m / static_cast<double>(measured) : NAN;
  }

  void step(const remote_touch_device& device, remote_touch_output& output) const {
    const double depth_m = height_m_ - device.position_m[1];
    if (!(depth_m > 0)) return;  // also without a point
    output.force_N[1] = kStiffness_N_per_m * depth_m;
    output.proxy_m[1] += depth_m;
    output.normal[1] = 1;
    output.state = REMOTE_TOUCH_CONTACT;
  }

  static constexpr double kStiffness_N_per_m = 500;

 private:
  double height_m_ = NAN;
};

const remote_touch_renderer kRenderer = {
    .name = "mean-plane",
    .summary = "a spring out of the mean height of the points, in C++",
    .degrees_of_freedom = 3,
    .contact_model = REMOTE_TOUCH_NOTHING,
    .max_stiffness_N_per_m = [](const double*) { return MeanPlane::kStiffness_N_per_m; },
    .rest_distance_m = [](const double*) { return 0.0; },
    .create = [](const double*, double, char*, size_t) -> void* { return new (std::nothrow) MeanPlane; },
    .destroy = [](void* renderer) { delete static_cast<MeanPlane*>(renderer); },
    .on_frame = [](void* renderer, const remote_touch_frame* frame, char*, size_t) -> int32_t {
      static_cast<MeanPlane*>(renderer)->take(*frame);
      return 0;
    },
    .step = [](void* renderer, const remote_touch_device* device, double, remote_touch_output* output, char*,
               size_t) -> int32_t {
      output->converged = 1;
      static_cast<MeanPlane*>(renderer)->step(*device, *output);
      return 0;
    }};

}  // namespace

extern "C" const remote_touch_renderer* remote_touch_plugin(uint32_t version, size_t size, size_t number) {
  const bool fits = version == REMOTE_TOUCH_PLUGIN_VERSION && size == sizeof kRenderer;
  return fits && number == 0 ? &kRenderer : nullptr;
}
