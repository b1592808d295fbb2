// Classes of Python as parts of the method: objects of a class, and entries of the catalog for renderers and
// scenarios written in Python.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/parameters/parameter.h"
#include "runners/experiment/catalog/catalog.h"

namespace remote_touch {

// An exception that a Python class raised, as an InputError of one line. raised() is its cause.
class PythonProblem : public InputError {
 public:
  PythonProblem(const std::string& subject, const std::string& problem, pybind11::error_already_set raised)
      : InputError(subject, problem),
        raised_(std::make_shared<pybind11::error_already_set>(std::move(raised))) {}
  pybind11::error_already_set& raised() const { return *raised_; }

 private:
  std::shared_ptr<pybind11::error_already_set> raised_;
};

// Returns the exception as text: "ValueError: the spring broke (mine.py, line 12)".
std::string problem_text(const pybind11::error_already_set& raised);

// Converts a number of Python. Throws error_already_set, with Python's own message, if it is none.
double real_of(const pybind11::handle& value);
int integer_of(const pybind11::handle& value);

// One setting of a class, and its present value.
struct PythonSetting {
  std::string name, help;
  double low = 0, high = 0;
  bool is_live = false;
  std::variant<double, int, bool, std::string, Vec3> value;
};

// The values of one object. A copy has values of its own; parameters() returns pointers to those of this
// object.
class PythonSettings {
 public:
  // settings: objects with name, value, low, high, help, live and integer; see rt.Setting. Throws InputError.
  PythonSettings(const std::string& subject, const pybind11::list& settings);
  Parameters parameters();
  void give_to(const pybind11::object& object) const;  // sets each as an attribute

 private:
  std::vector<PythonSetting> all_;
};

// The class lives as long as the process: the catalog may be destroyed after the interpreter.
class PythonClass {
 public:
  // kind: "renderer", "scenario", "trajectory". name: in the catalog.
  PythonClass(std::string kind, std::string name, const pybind11::object& type);
  const std::string& name() const { return name_; }
  std::string subject(const char* method) const;  // "renderer mine: Mine.step"

  // Returns a new object. Its attributes are the settings and the members of `given`. init: Init::called also
  // calls __init__. pre: this thread holds the interpreter's lock.
  enum class Init { skipped, called };
  pybind11::object object(const PythonSettings& settings, Init init, const pybind11::dict& given = {}) const;

  // Calls work() with the interpreter's lock. An exception that it raises becomes a PythonProblem of the
  // method.
  template <class Work>
  auto call(const char* method, Work&& work) const {
    const pybind11::gil_scoped_acquire lock;
    try {
      return work();
    } catch (pybind11::error_already_set& raised) {
      throw PythonProblem(subject(method), problem_text(raised), raised);
    } catch (const pybind11::cast_error&) {
      throw InputError(subject(method), "gave a value of another type than expected");
    }
  }

 private:
  const std::string kind_, name_;
  std::string type_name_;
  const pybind11::object& type_;  // never destroyed
};

// Holds an object of Python for an object of C++ that may be destroyed without the interpreter's lock.
class HeldObject {
 public:
  HeldObject() = default;
  ~HeldObject() {
    if (!object_) return;
    const pybind11::gil_scoped_acquire lock;
    object_ = pybind11::object();
  }
  HeldObject(const HeldObject&) = delete;
  HeldObject& operator=(const HeldObject&) = delete;
  void hold(pybind11::object object) { object_ = std::move(object); }  // pre: the lock
  const pybind11::object& operator*() const { return object_; }

 private:
  pybind11::object object_;
};

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
                                std::vector<FrameNeed> needs);
ScenarioEntry scenario_entry_of(PythonEntry entry);
TrajectoryEntry trajectory_entry_of(PythonEntry entry);

// The common part of all factories of such classes.
template <class Base>
class PythonFactory : public Base {
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
  std::vector<InputPart> inputs() const override { return {}; }

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
