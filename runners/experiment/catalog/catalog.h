// Everything that an experiment can name, as entries with factories.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/trace/measures.h"
#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "core/points/noise.h"
#include "core/rendering/renderer.h"
#include "runners/experiment/hand/trajectory.h"
#include "scenarios/recordings/recording.h"
#include "scenarios/simulated/scenario.h"

namespace remote_touch {

// Factories of catalog entries: they hold settings and build the object from them.

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

// Everything that an experiment can name, and the measures of its trace. A new scenario, fixture rule,
// trajectory or renderer of this project is one file pair and one line in catalog.cpp; a program of yours
// adds its own to built_in_catalog(), see runners/interfaces/cli/program.h. The contract tests
// (runners/evaluation/contract) then check it.
class Catalog {
 public:
  // Each function throws InputError if the name is taken, is empty or has characters other than lower case
  // letters, digits, - and _. A measure without a function is refused too.
  Catalog& add(ScenarioEntry entry) { return append(scenarios_, std::move(entry), "scenario"); }
  Catalog& add(FixtureEntry entry) { return append(fixtures_, std::move(entry), "fixture rule"); }
  Catalog& add(TrajectoryEntry entry) { return append(trajectories_, std::move(entry), "trajectory"); }
  Catalog& add(RendererEntry entry) { return append(renderers_, std::move(entry), "renderer"); }
  Catalog& add(Measure measure);

  std::span<const ScenarioEntry> scenarios() const { return scenarios_; }
  std::span<const FixtureEntry> fixtures() const { return fixtures_; }
  std::span<const TrajectoryEntry> trajectories() const { return trajectories_; }
  std::span<const RendererEntry> renderers() const { return renderers_; }
  std::span<const Measure> measures() const { return measures_; }
  bool is_empty() const;

 private:
  template <class Entry>
  Catalog& append(std::vector<Entry>& entries, Entry entry, const char* kind) {
    const auto has_its_name = [&](const Entry& other) { return other.name == entry.name; };
    require_name(kind, entry.name, std::ranges::any_of(entries, has_its_name));
    entries.push_back(std::move(entry));
    return *this;
  }
  static void require_name(const std::string& kind, const std::string& name, bool is_taken);

  std::vector<ScenarioEntry> scenarios_;
  std::vector<FixtureEntry> fixtures_;
  std::vector<TrajectoryEntry> trajectories_;
  std::vector<RendererEntry> renderers_;
  std::vector<Measure> measures_;
};

// The entries that come with this project.
const Catalog& built_in_catalog();

// Returns the entries of this catalog that the built-in one does not have.
Catalog own_entries(const Catalog& catalog);

// Replaces the built-in catalog by this one for the whole program. Must be called before the first experiment
// and from one thread: what the functions below returned before becomes invalid.
void use_catalog(Catalog catalog);

const Catalog& catalog_in_use();

// The entries of the catalog in use.
std::span<const ScenarioEntry> scenarios();
std::span<const FixtureEntry> fixtures();
std::span<const TrajectoryEntry> trajectories();
std::span<const RendererEntry> renderers();
std::span<const Measure> measures();
Directions directions();  // the better direction of each measure

// Returns the entry of that name. Throws InputError with the known names if there is none.
template <class Entry>
const Entry& find_entry(std::span<const Entry> entries, const std::string& name, const std::string& path) {
  std::string known;
  for (const Entry& entry : entries) {
    if (name == entry.name) return entry;
    known += (known.empty() ? "" : ", ") + entry.name;
  }
  throw InputError(path + " = \"" + name + "\"", "expected " + known);
}

}  // namespace remote_touch
