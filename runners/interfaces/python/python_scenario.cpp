// Scenarios and trajectories written in Python.
#include <pybind11/stl.h>

#include <cmath>

#include "core/geometry/point_cloud.h"
#include "core/parameters/input_error.h"
#include "runners/interfaces/python/arrays.h"
#include "runners/interfaces/python/clouds.h"
#include "runners/interfaces/python/python_entries.h"

namespace remote_touch {

namespace py = pybind11;

namespace {

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
class FactoryOf final : public PythonFactory<Interface, From...> {
 public:
  using PythonFactory<Interface, From...>::PythonFactory;
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
