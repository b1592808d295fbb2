// A renderer written in Python.
#include <algorithm>
#include <limits>

#include "core/parameters/input_error.h"
#include "runners/interfaces/python/arrays.h"
#include "runners/interfaces/python/clouds.h"
#include "runners/interfaces/python/python_entries.h"

namespace remote_touch {

namespace py = pybind11;

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

class PythonRendererFactory final : public PythonFactory<Renderer, double, const Kernels&> {
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
                                ContactModel contact_model, std::vector<FrameNeed> needs) {
  RendererEntry made;
  made.name = entry.name, made.summary = entry.summary;
  made.degrees_of_freedom = degrees_of_freedom, made.contact_model = contact_model;
  made.needs = std::move(needs);
  const bool has_tool = degrees_of_freedom == DegreesOfFreedom::six;
  made.make = [entry = std::move(entry), has_tool] {
    return std::make_unique<PythonRendererFactory>(entry, has_tool);
  };
  return made;
}

}  // namespace remote_touch
