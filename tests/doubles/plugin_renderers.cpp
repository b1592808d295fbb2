// A plug-in for tests: the renderer of chapter 4 behind the C interface, and renderers that break its rules.
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "core/dissertation/proxy/proxy_renderer.h"
#include "core/kernels/kernels.h"
#include "core/points/neighbour_search.h"
#include "runners/interfaces/plugins/remote_touch_plugin.h"

namespace {

using namespace remote_touch;

enum Setting { r1_m, stiffness_N_per_m, kSettings };

ProxyParameters parameters_of(const double* values) {
  ProxyParameters p;
  p.r1_m = values[r1_m];
  p.stiffness_N_per_m = values[stiffness_N_per_m];
  return p;
}

const remote_touch_setting* settings() {
  static const ProxyParameters defaults;
  static const remote_touch_setting all[kSettings] = {
      {"r1_m", "inner radius", defaults.r1_m, 1e-6, 1, 0},
      {"stiffness_N_per_m", "of the virtual coupling", defaults.stiffness_N_per_m, 0, 1e4, 1}};
  return all;
}

struct Proxy {
  ProxyRenderer renderer;
  double* stiffness = nullptr;  // the renderer's own
  Proxy(const ProxyParameters& p, double rate_hz) : renderer(p, rate_hz, kernels_for(best_isa())) {
    for (const Parameter& live : renderer.live_parameters())
      if (live.name == "stiffness_N_per_m") stiffness = std::get<double*>(live.value);
  }
};

double max_stiffness(const double* values) {
  return max_stiffness_N_per_m(parameters_of(values));
}
double rest_distance(const double* values) {
  return parameters_of(values).contact_radius_m();
}

void* create(const double* values, double rate_hz, char* problem, size_t size) {
  const ProxyParameters p = parameters_of(values);
  if (const std::string said = validate(p); !said.empty()) {
    std::snprintf(problem, size, "%s", said.c_str());
    return nullptr;
  }
  return new Proxy(p, rate_hz);
}
void destroy(void* renderer) {
  delete static_cast<Proxy*>(renderer);
}
void reserve(void* renderer, size_t points) {
  static_cast<Proxy*>(renderer)->renderer.reserve(points);
}

void take(std::vector<double>& column, const double* from, size_t count) {
  if (from) column.assign(from, from + count);
}

using Search = std::shared_ptr<const NeighbourSearch>;

Search search_of(const remote_touch_frame* frame) {
  PointCloud cloud;
  take(cloud.x, frame->x, frame->points), take(cloud.y, frame->y, frame->points);
  take(cloud.z, frame->z, frame->points);
  take(cloud.fixture_radius_m, frame->fixture_radius_m, frame->points);
  take(cloud.stiffness_N_per_m, frame->stiffness_N_per_m, frame->points);
  cloud.grid_columns = frame->columns;
  return make_search(std::move(cloud));
}

void* prepare(const void*, const remote_touch_frame* frame, char*, size_t) {
  return new Search(search_of(frame));
}
void release(void* prepared) {
  delete static_cast<Search*>(prepared);
}

int32_t on_frame(void* renderer, const remote_touch_frame* frame, char*, size_t) {
  const Search points = frame->prepared ? *static_cast<const Search*>(frame->prepared) : search_of(frame);
  static_cast<Proxy*>(renderer)->renderer.on_frame(
      {frame->index, frame->captured_s, frame->arrives_s, points});
  return 0;
}

void set(double (&to)[3], const Vec3& from) {
  for (int i = 0; i < 3; ++i) to[i] = from[i];
}

int32_t step(void* renderer, const remote_touch_device* device, double time_s, remote_touch_output* out,
             char*, size_t) {
  const double* p = device->position_m;
  const double* q = device->orientation;
  const RenderOutput made = static_cast<Proxy*>(renderer)->renderer.step(
      {Vec3(p[0], p[1], p[2]), Eigen::Quaterniond(q[0], q[1], q[2], q[3]), device->buttons}, time_s);
  set(out->proxy_m, made.proxy_W), set(out->force_N, made.force_N), set(out->slave_m, made.slave_W);
  set(out->normal, made.normal_W), set(out->frame_correction_m, made.frame_correction_m);
  out->surface_velocity_m_per_s = made.surface_velocity_m_per_s;
  out->nearest_distance_m = made.nearest_distance_m;
  out->state = static_cast<int32_t>(made.state), out->status = static_cast<int32_t>(made.status);
  out->steps = made.steps, out->converged = made.converged, out->contact_count = made.contact_count;
  return 0;
}

void set_values(void* renderer, const double* values) {
  Proxy& proxy = *static_cast<Proxy*>(renderer);
  *proxy.stiffness = values[stiffness_N_per_m];
  proxy.renderer.parameters_changed();
}

// --- renderers that break a rule, each in one function ---

int32_t throw_in_step(void*, const remote_touch_device*, double, remote_touch_output*, char*, size_t) {
  throw std::runtime_error("the spring broke");
}
int32_t refuse_step(void*, const remote_touch_device*, double, remote_touch_output*, char* problem,
                    size_t size) {
  std::snprintf(problem, size, "the spring is tired");
  return 1;
}
int32_t refuse_frame(void*, const remote_touch_frame*, char* problem, size_t size) {
  std::memset(problem, 'x', size);  // the text has no end
  return 7;
}
int32_t unknown_state(void*, const remote_touch_device*, double, remote_touch_output* out, char*, size_t) {
  out->state = 9;
  return 0;
}

remote_touch_renderer proxy(const char* name) {
  remote_touch_renderer r{};
  r.name = name, r.summary = "the proxy of chapter 4 behind the C interface, for tests";
  r.degrees_of_freedom = 3, r.contact_model = REMOTE_TOUCH_POINTS;
  r.setting_count = kSettings, r.settings = settings();
  r.max_stiffness_N_per_m = max_stiffness, r.rest_distance_m = rest_distance;
  r.create = create, r.destroy = destroy, r.reserve = reserve;
  r.prepare = prepare, r.release = release;
  r.on_frame = on_frame, r.step = step, r.set_values = set_values;
  return r;
}

const remote_touch_renderer* renderer_of(size_t number) {
  static const std::vector<remote_touch_renderer> all = [] {
    std::vector<remote_touch_renderer> made;
    for (const char* name : {"plug-in-proxy", "throws", "refuses-step", "refuses-frame", "unknown-state"})
      made.push_back(proxy(name));
    made[1].step = throw_in_step, made[2].step = refuse_step;
    made[3].on_frame = refuse_frame, made[4].step = unknown_state;
    return made;
  }();
  return number < all.size() ? &all[number] : nullptr;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const remote_touch_renderer* remote_touch_plugin(
    uint32_t version, size_t size, size_t number) {
  const bool fits = version == REMOTE_TOUCH_PLUGIN_VERSION && size == sizeof(remote_touch_renderer);
  return fits ? renderer_of(number) : nullptr;
}
