// Entries of the catalog for classes of Python.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <vector>

#include "runners/experiment/catalog/catalog.h"
#include "runners/interfaces/python/python_class.h"

namespace remote_touch {

// A class as it is registered: its name in the catalog, and the settings of its objects.
struct PythonEntry {
  std::string name, summary;
  std::shared_ptr<const PythonClass> type;
  PythonSettings settings;
};

// The methods of the classes are those of rt.Renderer, rt.Scenario and rt.Trajectory. Objects are made and
// called by any thread, one at a time because of the interpreter's lock. Whatever they raise ends the run
// with a PythonProblem.
RendererEntry renderer_entry_of(PythonEntry entry, DegreesOfFreedom degrees_of_freedom,
                                ContactModel contact_model, std::vector<FrameNeed> needs);
ScenarioEntry scenario_entry_of(PythonEntry entry);
TrajectoryEntry trajectory_entry_of(PythonEntry entry);

// The common part of all factories of such classes.
template <class Seam, class... Arguments>
class PythonFactory : public Factory<Seam, Arguments...> {
 public:
  explicit PythonFactory(const PythonEntry& entry) : type_(entry.type), settings_(entry.settings) {}
  Parameters settings() override { return settings_.parameters(); }
  // Returns the problem that validate() of the class reports; empty if it returns None (the settings are
  // valid).
  std::string validate() const override {
    return type_->call("validate", [&]() -> std::string {
      const pybind11::object said = type_->object(settings_, PythonClass::Init::skipped).attr("validate")();
      return said.is_none() ? std::string() : std::string(pybind11::str(said));
    });
  }
  std::vector<RecordingPart> inputs() const override { return {}; }
  double stiffness_N_per_m() const override { return 0; }
  RenderedContact contact() const override { return {}; }

 protected:
  double number_of(const char* method) const {
    return type_->call(method, [&] {
      return type_->object(settings_, PythonClass::Init::skipped).attr(method)().template cast<double>();
    });
  }
  std::shared_ptr<const PythonClass> type_;
  PythonSettings settings_;
};

}  // namespace remote_touch
