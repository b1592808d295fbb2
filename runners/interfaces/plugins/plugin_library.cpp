#include "runners/interfaces/plugins/plugin_library.h"

#include <dlfcn.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <limits>
#include <utility>

#include "core/parameters/parameter.h"
#include "core/points/neighbour_search.h"
#include "runners/evaluation/verification/metamorphic_checks.h"

namespace remote_touch {
namespace {

static_assert(kContactModels[REMOTE_TOUCH_REGIONS].renders_only_regions &&
              kContactModels[REMOTE_TOUCH_MESH].depends_on_point_order &&
              kContactModels[REMOTE_TOUCH_NOTHING].pressed_hip_passes_through &&
              kContactModels[REMOTE_TOUCH_SHEET].smooths_creases &&
              kContactModels[REMOTE_TOUCH_ORIENTED].uses_camera &&
              kContactModels[REMOTE_TOUCH_RESTING_POINTS].motion_amplifies_rounding &&
              REMOTE_TOUCH_ENTRENCHED == static_cast<int>(ContactState::entrenched) &&
              REMOTE_TOUCH_DEVICE_NOT_FINITE == static_cast<int>(RenderStatus::device_not_finite));

// The text in which a function of the library reports its failure. Nothing is allocated before a failure.
class Problem {
 public:
  char* text() { return text_.data(); }
  std::size_t size() const { return text_.size(); }
  std::string reason() const {
    const std::string said(text_.data(), strnlen(text_.data(), text_.size()));
    return said.empty() ? "gave no reason" : said;
  }
  [[noreturn]] void report(const remote_touch_renderer& functions, const char* call) const {
    throw InputError(std::string("plug-in renderer ") + functions.name + ": " + call, reason());
  }

 private:
  std::array<char, 256> text_{};
};

// Makes a call of a function of the library, see guarded_call().
template <class Call>
auto guarded(const remote_touch_renderer& functions, const char* name, Call&& call) {
  return guarded_call([&] { return std::string("plug-in renderer ") + functions.name + ": " + name; },
                      std::forward<Call>(call));
}

// Makes a call of the library that frees something. Its exceptions are ignored: the caller may be a
// destructor.
template <class Call>
void freed(Call&& call) noexcept {
  try {
    call();
  } catch (...) {
  }
}

const double* start_of(const std::vector<double>& column) {
  return column.empty() ? nullptr : column.data();
}

// The result of the library's prepare() for a frame.
struct Prepared final : FramePreparation {
  Prepared(const remote_touch_renderer& of, void* made) : functions(of), handle(made) {}
  ~Prepared() override {
    freed([this] { functions.release(handle); });
  }
  Prepared(const Prepared&) = delete;
  Prepared& operator=(const Prepared&) = delete;
  const remote_touch_renderer& functions;
  void* handle;
};

remote_touch_frame as_c(const Frame& frame, const PointCloud& cloud) {
  remote_touch_frame c{};
  c.index = frame.index, c.columns = cloud.columns();
  c.captured_s = frame.captured_s, c.arrives_s = frame.arrives_s;
  c.points = cloud.size();
  c.x = cloud.x.data(), c.y = cloud.y.data(), c.z = cloud.z.data();
  c.nx = start_of(cloud.nx), c.ny = start_of(cloud.ny), c.nz = start_of(cloud.nz);
  c.fixture_radius_m = start_of(cloud.fixture_radius_m);
  c.stiffness_N_per_m = start_of(cloud.stiffness_N_per_m);
  c.colour = cloud.colour.empty() ? nullptr : cloud.colour.data();
  return c;
}

void set(double (&to)[3], const Vec3& from) {
  for (int i = 0; i < 3; ++i) to[i] = from[i];
}
Vec3 vector_of(const double (&from)[3]) {
  return {from[0], from[1], from[2]};
}
void set(double (&to)[4], const Eigen::Quaterniond& q) {
  to[0] = q.w(), to[1] = q.x(), to[2] = q.y(), to[3] = q.z();
}

remote_touch_device as_c(const DeviceState& device) {
  remote_touch_device c{};
  set(c.position_m, device.position_W);
  set(c.orientation, device.orientation_W);
  c.buttons = device.buttons;
  return c;
}

remote_touch_output empty_output(const DeviceState& device) {
  remote_touch_output out{};
  set(out.proxy_m, device.position_W);
  set(out.slave_m, Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  out.nearest_distance_m = std::numeric_limits<double>::infinity();
  set(out.tool_orientation, device.orientation_W);
  return out;
}

int in_range(std::int32_t value, int max, const remote_touch_renderer& functions, const char* what) {
  if (value < 0 || value > max)
    throw InputError(
        std::string("plug-in renderer ") + functions.name + ": " + what + " = " + std::to_string(value),
        "expected 0 to " + std::to_string(max));
  return value;
}

ToolOutput tool_of(const remote_touch_output& c) {
  ToolOutput tool;
  const double(&q)[4] = c.tool_orientation;
  tool.orientation_W = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
  tool.torque_Nm = vector_of(c.torque_Nm);
  tool.active_constraints = c.active_constraints, tool.contact_clusters = c.contact_clusters;
  tool.detections = c.detections, tool.budget_exhausted = c.budget_exhausted != 0;
  tool.tool_penetration_m = c.tool_penetration_m;
  return tool;
}

RenderOutput output_of(const remote_touch_output& c, const remote_touch_renderer& functions) {
  RenderOutput out;
  out.proxy_W = vector_of(c.proxy_m), out.force_N = vector_of(c.force_N), out.slave_W = vector_of(c.slave_m);
  out.normal_W = vector_of(c.normal), out.frame_correction_m = vector_of(c.frame_correction_m);
  out.surface_velocity_m_per_s = c.surface_velocity_m_per_s;
  out.nearest_distance_m = c.nearest_distance_m;
  out.state = static_cast<ContactState>(in_range(c.state, REMOTE_TOUCH_ENTRENCHED, functions, "state"));
  out.status =
      static_cast<RenderStatus>(in_range(c.status, REMOTE_TOUCH_DEVICE_NOT_FINITE, functions, "status"));
  out.steps = c.steps, out.converged = c.converged != 0, out.contact_count = c.contact_count;
  if (functions.degrees_of_freedom == 6) out.tool = tool_of(c);
  return out;
}

Parameters parameters_of(const remote_touch_renderer& functions, std::vector<double>& values) {
  Parameters all;
  for (std::size_t i = 0; i < functions.setting_count; ++i) {
    const remote_touch_setting& s = functions.settings[i];
    all.push_back({s.name, &values[i], s.low, s.high, s.help, s.is_live != 0});
  }
  return all;
}

class PluginFactory final : public RendererFactory {
 public:
  explicit PluginFactory(const remote_touch_renderer& functions) : functions_(functions) {
    for (std::size_t i = 0; i < functions.setting_count; ++i) values_.push_back(functions.settings[i].value);
  }
  Parameters settings() override { return parameters_of(functions_, values_); }
  // The library checks combinations of values when it makes a renderer, so one is made and destroyed here.
  std::string validate() const override {
    Problem problem;
    void* made = guarded(functions_, "create", [&] {
      return functions_.create(values_.data(), 1000, problem.text(), problem.size());
    });
    if (made == nullptr) return problem.reason();
    freed([&] { functions_.destroy(made); });
    return {};
  }
  std::vector<InputPart> inputs() const override { return {}; }
  double stiffness_N_per_m() const override {
    return guarded(functions_, "max_stiffness_N_per_m",
                   [&] { return functions_.max_stiffness_N_per_m(values_.data()); });
  }
  RenderedContact contact() const override {
    if (!functions_.rest_distance_m) return RenderedContact::unknown();
    return {
        guarded(functions_, "rest_distance_m", [&] { return functions_.rest_distance_m(values_.data()); })};
  }
  std::unique_ptr<Renderer> build(double haptic_rate_hz, const Kernels& kernels) const override {
    return std::make_unique<PluginRenderer>(functions_, values_, haptic_rate_hz, kernels);
  }

 private:
  const remote_touch_renderer& functions_;
  std::vector<double> values_;
};

constexpr std::size_t kMaxRenderers = 1000, kMaxSettings = 1000;

// Removes the file's name from the start of the loader's text, because the error already has it.
std::string loader_problem(const std::string& file) {
  const char* said = ::dlerror();
  std::string text = said ? said : "cannot be loaded";
  if (text.starts_with(file + ": ")) text.erase(0, file.size() + 2);
  return text;
}

remote_touch_plugin_function function_of(const std::string& file) {
  std::error_code unreachable;
  if (!std::filesystem::is_regular_file(file, unreachable))
    throw InputError("--plugin " + file, "no such file: expected a shared library");
  const std::string path = std::filesystem::absolute(file).string();
  void* library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr)
    throw InputError("--plugin " + file, loader_problem(path) + ": expected a shared library");
  void* address = ::dlsym(library, REMOTE_TOUCH_PLUGIN_FUNCTION);
  if (address == nullptr)
    throw InputError("--plugin " + file, "has no function " REMOTE_TOUCH_PLUGIN_FUNCTION
                                         "(): expected a library as remote_touch_plugin.h describes it");
  return reinterpret_cast<remote_touch_plugin_function>(address);
}

void check(const remote_touch_renderer& r, const std::string& file) {
  const auto refuse = [&](const std::string& what) {
    throw InputError("--plugin " + file, (r.name ? std::string(r.name) + ": " : std::string()) + what);
  };
  if (!r.name || !r.summary) refuse("a renderer without name or summary");
  if (r.degrees_of_freedom != 3 && r.degrees_of_freedom != 6) refuse("degrees_of_freedom: expected 3 or 6");
  if (r.contact_model < REMOTE_TOUCH_POINTS || r.contact_model > REMOTE_TOUCH_RESTING_POINTS)
    refuse("contact_model: expected REMOTE_TOUCH_POINTS to REMOTE_TOUCH_RESTING_POINTS");
  const auto require = [&](const char* name, bool is_there) {
    if (!is_there) refuse(std::string("lacks the function ") + name);
  };
  require("max_stiffness_N_per_m", r.max_stiffness_N_per_m != nullptr),
      require("create", r.create != nullptr);
  require("destroy", r.destroy != nullptr), require("on_frame", r.on_frame != nullptr),
      require("step", r.step != nullptr);
  if (!r.prepare != !r.release)
    refuse("has only one of the functions prepare and release: expected both or neither");
  if (r.setting_count > kMaxSettings || (r.setting_count > 0 && !r.settings))
    refuse("settings: expected at most " + std::to_string(kMaxSettings));
  bool any_live = false;
  for (std::size_t i = 0; i < r.setting_count; ++i) {
    const remote_touch_setting& s = r.settings[i];
    if (!s.name || !s.help) refuse("a setting without name or help");
    if (!(s.low <= s.value && s.value <= s.high))
      refuse(std::string(s.name) + " = " + formatted("%g", s.value) + ": expected " + formatted("%g", s.low) +
             " to " + formatted("%g", s.high));
    any_live |= s.is_live != 0;
  }
  if (any_live && !r.set_values) refuse("has live settings and no set_values");
}

}  // namespace

PluginRenderer::PluginRenderer(const remote_touch_renderer& functions, const std::vector<double>& values,
                               double haptic_rate_hz, const Kernels& kernels)
    : functions_(functions), kernels_(kernels), values_(values) {
  Problem problem;
  renderer_ = guarded(functions_, "create", [&] {
    return functions_.create(values_.data(), haptic_rate_hz, problem.text(), problem.size());
  });
  if (renderer_ == nullptr) problem.report(functions_, "create");
}

PluginRenderer::~PluginRenderer() {
  freed([this] { functions_.destroy(renderer_); });
}

void PluginRenderer::reserve(std::size_t points) {
  if (functions_.reserve) guarded(functions_, "reserve", [&] { functions_.reserve(renderer_, points); });
}

void PluginRenderer::prepare(Frame& frame) const {
  if (!functions_.prepare) return;
  PointCloud buffer;
  const remote_touch_frame c = as_c(frame, frame.points->every_point(kernels_, buffer));
  Problem problem;
  void* made = guarded(functions_, "prepare",
                       [&] { return functions_.prepare(renderer_, &c, problem.text(), problem.size()); });
  if (made == nullptr) problem.report(functions_, "prepare");
  frame.prepared = std::make_shared<Prepared>(functions_, made);
}

void PluginRenderer::on_frame(const Frame& frame) {
  if (!order_.accept_if_newer(frame)) return;
  remote_touch_frame c = as_c(frame, frame.points->every_point(kernels_, buffer_));
  const auto prepared = std::dynamic_pointer_cast<const Prepared>(frame.prepared);
  if (prepared && &prepared->functions == &functions_) c.prepared = prepared->handle;
  Problem problem;
  if (guarded(functions_, "on_frame",
              [&] { return functions_.on_frame(renderer_, &c, problem.text(), problem.size()); }) != 0)
    problem.report(functions_, "on_frame");
  prepared_ = prepared;
}

Parameters PluginRenderer::live_parameters() {
  return live_ones(parameters_of(functions_, values_));
}

void PluginRenderer::parameters_changed() {
  if (functions_.set_values)
    guarded(functions_, "set_values", [&] { functions_.set_values(renderer_, values_.data()); });
}

RenderOutput PluginRenderer::step(const DeviceState& device, double time_s) {
  const remote_touch_device c = as_c(device);
  remote_touch_output out = empty_output(device);
  Problem problem;
  if (guarded(functions_, "step", [&] {
        return functions_.step(renderer_, &c, time_s, &out, problem.text(), problem.size());
      }) != 0)
    problem.report(functions_, "step");
  RenderOutput made = output_of(out, functions_);
  made.frame_index = order_.newest();
  made.status = order_.status(made.status);
  return made;
}

std::unique_ptr<RendererFactory> plugin_factory(const remote_touch_renderer& functions) {
  return std::make_unique<PluginFactory>(functions);
}

std::vector<RendererEntry> load_plugin(const std::string& file) {
  const remote_touch_plugin_function function = function_of(file);
  const auto renderer_with = [&](std::size_t number) {
    return guarded_call(
        [&] { return "--plugin " + file; },
        [&] { return function(REMOTE_TOUCH_PLUGIN_VERSION, sizeof(remote_touch_renderer), number); });
  };
  std::vector<RendererEntry> entries;
  for (std::size_t number = 0; number < kMaxRenderers; ++number) {
    const remote_touch_renderer* functions = renderer_with(number);
    if (functions == nullptr) break;
    check(*functions, file);
    RendererEntry entry;
    entry.name = functions->name, entry.summary = functions->summary;
    entry.make = [functions] { return plugin_factory(*functions); };
    entry.degrees_of_freedom =
        functions->degrees_of_freedom == 6 ? DegreesOfFreedom::six : DegreesOfFreedom::three;
    declare_contact_model(entry.name, kContactModels[functions->contact_model]);
    entries.push_back(std::move(entry));
  }
  if (entries.size() == kMaxRenderers && renderer_with(kMaxRenderers) != nullptr)
    throw InputError("--plugin " + file,
                     "has too many renderers: expected at most " + std::to_string(kMaxRenderers));
  if (entries.empty())
    throw InputError("--plugin " + file, "has no renderer for version " +
                                             std::to_string(REMOTE_TOUCH_PLUGIN_VERSION) +
                                             " of the interface: expected a library of that version");
  return entries;
}

}  // namespace remote_touch
