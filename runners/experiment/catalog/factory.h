// Factories of catalog entries: they hold settings and build the object from them.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "core/points/noise.h"
#include "core/rendering/frame.h"
#include "core/rendering/renderer.h"
#include "runners/experiment/hand/trajectory.h"
#include "scenarios/recordings/recording.h"
#include "scenarios/scene/scenario.h"

namespace remote_touch {

struct ToolSettings;

// Settings that can be read, listed and checked.
class Configurable {
 public:
  virtual ~Configurable() = default;
  virtual Parameters settings() = 0;         // pointers into this object
  virtual std::string validate() const = 0;  // "r1_m = 1: expected ..."; empty: they are valid
};

template <class Seam, class... Arguments>
class Factory : public Configurable {
 public:
  virtual std::vector<InputPart> inputs() const = 0;  // the files that the settings name; mostly none
  virtual std::unique_ptr<Seam> build(Arguments... arguments) const = 0;
};

class RendererFactory : public Factory<Renderer, double, const Kernels&> {  // the haptic rate in Hz
 public:
  virtual double stiffness_N_per_m() const = 0;  // see max_stiffness_N_per_m() below
  virtual RenderedContact contact() const = 0;
  virtual const ToolSettings* tool() const { return nullptr; }  // the tool as settings, if it has one
};

// Builds a product that has a constructor (Settings, Arguments...). The namespace of the settings has these
// functions:
// - Parameters parameters(Settings&): the settings by name
// - std::string validate(const Settings&): empty, or the first problem: "r1_m = 1: expected below r2_m"
// - InputPart input_files(const Settings&), or a vector of them: if the settings name files
template <class Product, class Settings, class Base, class Seam, class... Arguments>
class FactoryFor : public Base {
 public:
  Parameters settings() override { return parameters(values_); }
  std::string validate() const override {
    using remote_touch::validate;
    return validate(values_);
  }
  std::vector<InputPart> inputs() const override {
    if constexpr (requires { input_files(values_); })
      return {input_files(values_)};
    else
      return {};
  }
  std::unique_ptr<Seam> build(Arguments... arguments) const override {
    return std::make_unique<Product>(values_, arguments...);
  }

 protected:
  Settings values_;
};

// Builds a renderer. The namespace of its settings has two more functions:
// - double max_stiffness_N_per_m(const Settings&): an upper bound of the growth of |force| with the
//   displacement of the HIP
// - RenderedContact rendered_contact(const Settings&): RenderedContact::unknown() if it is not known
// A renderer of a tool that a slave can have keeps the settings of the tool as Settings::tool.
template <class Product, class Settings>
class RendererFactoryFor final
    : public FactoryFor<Product, Settings, RendererFactory, Renderer, double, const Kernels&> {
 public:
  double stiffness_N_per_m() const override { return max_stiffness_N_per_m(this->values_); }
  RenderedContact contact() const override { return rendered_contact(this->values_); }
  const ToolSettings* tool() const override {
    if constexpr (requires(const ToolSettings* found) { found = &this->values_.tool; })
      return &this->values_.tool;
    else
      return nullptr;
  }
};

template <class Made>
struct CatalogEntry {
  std::string name;     // lower case letters, digits, - and _
  std::string summary;  // one line, for lists
  std::function<std::unique_ptr<Made>()> make;
};

using ScenarioEntry = CatalogEntry<Factory<Scenario, const NoiseKey&, const Kernels&>>;
using FixtureEntry = CatalogEntry<Factory<FixtureRule>>;

struct TrajectoryEntry : CatalogEntry<Factory<Trajectory, const Scenario&>> {
  bool has_buttons = false;  // replays the button presses of a recorded device
};

// Degrees of freedom that a renderer uses: six if its outputs have RenderOutput::tool.
enum class DegreesOfFreedom { three, six };

struct RendererEntry : CatalogEntry<RendererFactory> {
  DegreesOfFreedom degrees_of_freedom = DegreesOfFreedom::three;
  std::vector<FrameNeed> needs = {};  // runs whose frames lack them are refused
};

// --- entries from classes ---

template <class Product, class Settings, class... Seam>
std::unique_ptr<Factory<Seam...>> factory() {
  return std::make_unique<FactoryFor<Product, Settings, Factory<Seam...>, Seam...>>();
}

template <class Product, class Settings = typename Product::Settings>
ScenarioEntry scenario_entry(std::string name, std::string summary) {
  return {std::move(name), std::move(summary),
          factory<Product, Settings, Scenario, const NoiseKey&, const Kernels&>};
}

template <class Product, class Settings = typename Product::Settings>
FixtureEntry fixture_entry(std::string name, std::string summary) {
  return {std::move(name), std::move(summary), factory<Product, Settings, FixtureRule>};
}

template <class Product, class Settings = typename Product::Settings>
TrajectoryEntry trajectory_entry(std::string name, std::string summary, bool has_buttons = false) {
  return {{std::move(name), std::move(summary), factory<Product, Settings, Trajectory, const Scenario&>},
          has_buttons};
}

template <class Product, class Settings = typename Product::Settings>
RendererEntry renderer_entry(std::string name, DegreesOfFreedom degrees_of_freedom, std::string summary,
                             std::vector<FrameNeed> needs = {}) {
  return {{std::move(name), std::move(summary),
           [] { return std::make_unique<RendererFactoryFor<Product, Settings>>(); }},
          degrees_of_freedom,
          std::move(needs)};
}

}  // namespace remote_touch
