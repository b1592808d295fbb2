#include "runners/interfaces/python/python_class.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/points/point_cloud.h"
#include "runners/interfaces/python/arrays.h"
#include "runners/interfaces/python/clouds.h"

namespace remote_touch {

namespace py = pybind11;

namespace {

std::variant<double, int, bool, std::string, Vec3> value_of(const py::object& value, bool is_integer,
                                                            const Subject& subject) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>();
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  if (is_integer && py::isinstance<py::int_>(value)) return value.cast<int>();
  if (py::isinstance<py::int_>(value) || py::isinstance<py::float_>(value)) return value.cast<double>();
  return vector_of(value, subject);
}

void check(const PythonSetting& setting, const std::string& subject) {
  const auto is_out = [&](double x) { return !(setting.low <= x && x <= setting.high); };
  bool wrong = false;
  if (const auto* number = std::get_if<double>(&setting.value)) wrong = is_out(*number);
  if (const auto* number = std::get_if<int>(&setting.value)) wrong = is_out(*number);
  if (const auto* vector = std::get_if<Vec3>(&setting.value))
    wrong = is_out(vector->x()) || is_out(vector->y()) || is_out(vector->z());
  if (wrong) throw InputError(subject, "its value is not in its range: expected low <= value <= high");
}

PythonSetting setting_of(const py::handle& given, const std::string& of_class) {
  PythonSetting setting;
  setting.name = given.attr("name").cast<std::string>();
  const std::string subject = of_class + ": setting " + setting.name;
  if (setting.name.empty() || setting.name == "name") throw InputError(subject, "expected another name");
  setting.help = given.attr("help").cast<std::string>();
  setting.low = given.attr("low").cast<double>(), setting.high = given.attr("high").cast<double>();
  setting.is_live = given.attr("live").cast<bool>();
  setting.value = value_of(given.attr("value"), given.attr("integer").cast<bool>(), [&] { return subject; });
  if (setting.is_live && !std::holds_alternative<double>(setting.value) &&
      !std::holds_alternative<bool>(setting.value))
    throw InputError(subject, "is live: expected a number or a switch");
  check(setting, subject);
  return setting;
}

}  // namespace

std::string problem_text(const py::error_already_set& raised) {
  std::string text = py::str(raised.type().attr("__name__"));
  const std::string said = py::str(raised.value());
  if (!said.empty()) text += ": " + said;
  py::object place = raised.trace() ? py::object(raised.trace()) : py::none();
  if (place.is_none()) return text;
  for (py::object next = place.attr("tb_next"); !next.is_none(); next = next.attr("tb_next")) place = next;
  const std::string file = py::str(place.attr("tb_frame").attr("f_code").attr("co_filename"));
  const std::string line = py::str(place.attr("tb_lineno"));
  return text + " (" + file.substr(file.rfind('/') + 1) + ", line " + line + ")";
}

double real_of(const py::handle& value) {
  const double number = PyFloat_AsDouble(value.ptr());
  if (number == -1 && PyErr_Occurred() != nullptr) throw py::error_already_set();
  return number;
}

int integer_of(const py::handle& value) {
  const long number = PyLong_AsLong(value.ptr());
  if (number == -1 && PyErr_Occurred() != nullptr) throw py::error_already_set();
  return static_cast<int>(
      std::clamp<long>(number, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()));
}

PythonSettings::PythonSettings(const std::string& subject, const py::list& settings) {
  for (const py::handle& setting : settings) all_.push_back(setting_of(setting, subject));
}

Parameters PythonSettings::parameters() {
  Parameters list;
  for (PythonSetting& s : all_)
    std::visit(
        [&](auto& value) {
          list.push_back({s.name, &value, s.low, s.high, s.help, s.is_live});
        },
        s.value);
  return list;
}

void PythonSettings::give_to(const py::object& object) const {
  for (const PythonSetting& setting : all_) {
    const py::object value = std::visit(
        []<class Value>(const Value& own) -> py::object {
          if constexpr (std::is_same_v<Value, Vec3>)
            return array_of(own);
          else
            return py::cast(own);
        },
        setting.value);
    object.attr(setting.name.c_str()) = value;
  }
}

PythonClass::PythonClass(std::string kind, std::string name, const py::object& type)
    : kind_(std::move(kind)), name_(std::move(name)), type_(*new py::object(type)) {
  type_name_ = py::str(type.attr("__name__"));
}

std::string PythonClass::subject(const char* method) const {
  return kind_ + " " + name_ + ": " + type_name_ + "." + method;
}

py::object PythonClass::object(const PythonSettings& settings, Init init, const py::dict& given) const {
  py::object object = type_.attr("__new__")(type_);
  settings.give_to(object);
  for (const auto& [name, value] : given) py::setattr(object, name, value);
  if (init == Init::called) object.attr("__init__")();
  return object;
}

namespace {

class PythonRenderer final : public Renderer {
 public:
  PythonRenderer(std::shared_ptr<const PythonClass> type, const PythonSettings& settings,
                 double haptic_rate_hz, bool has_tool, const Kernels& kernels)
      : type_(std::move(type)), settings_(settings), has_tool_(has_tool), kernels_(kernels) {
    type_->call("__init__", [&] {
      py::dict given;
      given["haptic_rate_hz"] = haptic_rate_hz;
      object_.hold(type_->object(settings_, PythonClass::Init::called, given));
      step_.hold((*object_).attr("step"));
    });
  }

  void on_frame(const Frame& frame) override {
    type_->call("on_frame",
                [&] { (*object_).attr("on_frame")(std::make_shared<PythonFrame>(frame, kernels_)); });
    newest_ = std::max(newest_, frame.index);
  }

  Parameters live_parameters() override { return live_ones(settings_.parameters()); }
  void parameters_changed() override {
    type_->call("parameters_changed", [&] {
      settings_.give_to(*object_);
      (*object_).attr("parameters_changed")();
    });
  }

  RenderOutput step(const DeviceState& device, double time_s) override {
    return type_->call("step", [&] {
      const py::object given = (*step_)(py::cast(device), time_s);
      if (!py::isinstance<PythonOutput>(given))
        throw InputError(type_->subject("step"),
                         "returned " + std::string(py::str(py::type::of(given))) + ": expected rt.Output");
      return output_of(given.cast<const PythonOutput&>(), device);
    });
  }

 private:
  RenderOutput output_of(const PythonOutput& given, const DeviceState& device) const {
    RenderOutput out = given.output;
    if (!given.has_proxy) out.proxy_W = device.position_W;
    out.frame_index = newest_;
    if (!has_tool_ && (given.torque_Nm || given.tool_orientation))
      throw InputError(type_->subject("step"),
                       "returned a torque or the orientation of a tool: expected a class "
                       "with degrees_of_freedom = 6");
    if (has_tool_) {
      out.tool.emplace();
      out.tool->torque_Nm = given.torque_Nm.value_or(Vec3(Vec3::Zero()));
      out.tool->orientation_W = given.tool_orientation.value_or(device.orientation_W);
    }
    return out;
  }

  const std::shared_ptr<const PythonClass> type_;
  PythonSettings settings_;
  const bool has_tool_;
  const Kernels& kernels_;
  HeldObject object_, step_;
  int newest_ = -1;
};

class PythonRendererFactory final : public PythonFactory<RendererFactory> {
 public:
  PythonRendererFactory(const PythonEntry& entry, bool has_tool)
      : PythonFactory(entry), has_tool_(has_tool) {}
  double stiffness_N_per_m() const override { return number_of("max_stiffness_N_per_m"); }
  RenderedContact contact() const override {
    return {number_of("rest_distance_m"), number_of("spring_N_per_m")};
  }
  std::unique_ptr<Renderer> build(double haptic_rate_hz, const Kernels& kernels) const override {
    return std::make_unique<PythonRenderer>(type_, settings_, haptic_rate_hz, has_tool_, kernels);
  }

 private:
  const bool has_tool_;
};

}  // namespace

RendererEntry renderer_entry_of(PythonEntry entry, DegreesOfFreedom degrees_of_freedom,
                                std::vector<FrameNeed> needs) {
  RendererEntry made;
  made.name = entry.name, made.summary = entry.summary;
  made.degrees_of_freedom = degrees_of_freedom, made.needs = std::move(needs);
  const bool has_tool = degrees_of_freedom == DegreesOfFreedom::six;
  made.make = [entry = std::move(entry), has_tool] {
    return std::make_unique<PythonRendererFactory>(entry, has_tool);
  };
  return made;
}

namespace {

// Scenarios and trajectories written in Python.

constexpr int kMaxFrames = 1 << 28;  // a frame's number is part of the noise key

// Returns the attribute of that name; if it is a method, returns the result of a call.
py::object value_of(const py::object& object, const char* name) {
  py::object value = object.attr(name);
  return PyCallable_Check(value.ptr()) != 0 ? value() : value;
}

class PythonScenario final : public Scenario {
 public:
  PythonScenario(std::shared_ptr<const PythonClass> type, const PythonSettings& settings, const NoiseKey& key,
                 const Kernels&)
      : type_(std::move(type)) {
    type_->call("__init__", [&] {
      py::dict given;
      given["key"] = key;
      object_.hold(type_->object(settings, PythonClass::Init::called, given));
    });
    type_->call("frame_rate_hz", [&] { frame_rate_hz_ = real_of(value_of(*object_, "frame_rate_hz")); });
    type_->call("frame_count", [&] { frame_count_ = integer_of(value_of(*object_, "frame_count")); });
    if (!(frame_rate_hz_ > 0) || !std::isfinite(frame_rate_hz_))
      throw InputError(type_->subject("frame_rate_hz"), "expected a number above 0");
    if (frame_count_ < 1 || frame_count_ >= kMaxFrames)
      throw InputError(type_->subject("frame_count"), "expected 1 to " + std::to_string(kMaxFrames - 1));
  }

  double frame_rate_hz() const override { return frame_rate_hz_; }
  int frame_count() const override { return frame_count_; }
  PointCloud cloud(int frame) const override {
    return type_->call("cloud", [&] {
      const py::object given = (*object_).attr("cloud")(frame);
      return cloud_of(given, [this] { return type_->subject("cloud") + ": points"; });
    });
  }
  double signed_distance(const Vec3& p_W, double time_s) const override {
    return type_->call("signed_distance",
                       [&] { return real_of((*object_).attr("signed_distance")(array_of(p_W), time_s)); });
  }
  double surface_height(double x, double z, double time_s) const override {
    return type_->call("surface_height",
                       [&] { return real_of((*object_).attr("surface_height")(x, z, time_s)); });
  }

 private:
  const std::shared_ptr<const PythonClass> type_;
  HeldObject object_;
  double frame_rate_hz_ = 0;
  int frame_count_ = 0;
};

class PythonTrajectory final : public Trajectory {
 public:
  PythonTrajectory(std::shared_ptr<const PythonClass> type, const PythonSettings& settings,
                   const Scenario& scenario)
      : type_(std::move(type)), scene_(std::make_shared<PythonScene>(scenario)) {
    type_->call("__init__", [&] {
      py::dict given;
      given["scene"] = scene_;
      object_.hold(type_->object(settings, PythonClass::Init::called, given));
      at_.hold((*object_).attr("at"));
    });
    type_->call("duration_s", [&] { duration_s_ = real_of(value_of(*object_, "duration_s")); });
    if (!(duration_s_ >= 0) || std::isinf(duration_s_))
      throw InputError(type_->subject("duration_s"), "expected a number of 0 or more");
  }
  ~PythonTrajectory() override { scene_->take_back(); }

  DeviceState at(double time_s) const override {
    return type_->call("at", [&] {
      const DeviceState hand = device_of((*at_)(time_s));
      if (!is_near_origin(hand.position_W))
        throw InputError(type_->subject("at"), far_from_origin("a position"));
      return hand;
    });
  }
  double duration_s() const override { return duration_s_; }

 private:
  DeviceState device_of(const py::object& given) const {
    if (py::isinstance<DeviceState>(given)) return given.cast<DeviceState>();
    const auto subject = [this] { return type_->subject("at"); };
    if (!py::isinstance<py::tuple>(given) || py::len(given) != 2) return {vector_of(given, subject)};
    const auto pair = py::reinterpret_borrow<py::tuple>(given);
    return {vector_of(pair[0], subject), quaternion_of(pair[1], subject)};
  }

  const std::shared_ptr<const PythonClass> type_;
  const std::shared_ptr<PythonScene> scene_;
  HeldObject object_, at_;
  double duration_s_ = 0;
};

// A factory of objects that are made from the class, the settings and these arguments.
template <class Made, class Interface, class... From>
class FactoryOf final : public PythonFactory<Factory<Interface, From...>> {
 public:
  using PythonFactory<Factory<Interface, From...>>::PythonFactory;
  std::unique_ptr<Interface> build(From... from) const override {
    return std::make_unique<Made>(this->type_, this->settings_, from...);
  }
};
using PythonScenarioFactory = FactoryOf<PythonScenario, Scenario, const NoiseKey&, const Kernels&>;
using PythonTrajectoryFactory = FactoryOf<PythonTrajectory, Trajectory, const Scenario&>;

}  // namespace

ScenarioEntry scenario_entry_of(PythonEntry entry) {
  ScenarioEntry made{entry.name, entry.summary, {}};
  made.make = [entry = std::move(entry)] { return std::make_unique<PythonScenarioFactory>(entry); };
  return made;
}

TrajectoryEntry trajectory_entry_of(PythonEntry entry) {
  TrajectoryEntry made;
  made.name = entry.name, made.summary = entry.summary;
  made.make = [entry = std::move(entry)] { return std::make_unique<PythonTrajectoryFactory>(entry); };
  return made;
}

}  // namespace remote_touch
