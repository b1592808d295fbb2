// Factories of catalog entries: they hold settings and build the object from them.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/dissertation/virtual_fixtures/fixture_rule.h"
#include "core/kernels/kernels.h"
#include "core/numeric/noise.h"
#include "core/parameters/parameter.h"
#include "core/rendering/frame_need.h"
#include "core/rendering/renderer.h"
#include "runners/experiment/catalog/rendered_contact.h"
#include "runners/experiment/hand/trajectory.h"
#include "scenarios/interface/scenario.h"
#include "scenarios/recordings/recording_part.h"

namespace remote_touch {

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
  virtual std::vector<RecordingPart> inputs() const = 0;  // the files that the settings name; mostly none
  // Returns max_stiffness_N_per_m() of the settings of a renderer; 0 for other products.
  virtual double stiffness_N_per_m() const = 0;
  virtual RenderedContact contact() const = 0;  // used only for renderers
  virtual std::unique_ptr<Seam> build(Arguments... arguments) const = 0;
};

// Builds a product that has a constructor (Settings, Arguments...). The namespace of the settings has these
// functions:
// - Parameters parameters(Settings&): the settings by name
// - std::string validate(const Settings&): empty, or the first problem: "r1_m = 1: expected below r2_m"
// - double max_stiffness_N_per_m(const Settings&): needed for every renderer, not used for other products
// - RenderedContact rendered_contact(const Settings&): for a renderer whose rest distance is known
// - RecordingPart input_files(const Settings&), or a vector of them: if the settings name files
template <class Product, class Settings, class Seam, class... Arguments>
class FactoryFor final : public Factory<Seam, Arguments...> {
 public:
  Parameters settings() override { return parameters(values_); }
  std::string validate() const override {
    using remote_touch::validate;
    return validate(values_);
  }
  std::vector<RecordingPart> inputs() const override {
    if constexpr (requires { input_files(values_); })
      return {input_files(values_)};
    else
      return {};
  }
  double stiffness_N_per_m() const override {
    if constexpr (std::is_base_of_v<Renderer, Product>)
      return max_stiffness_N_per_m(values_);
    else
      return 0;
  }
  RenderedContact contact() const override {
    if constexpr (requires { rendered_contact(values_); })
      return rendered_contact(values_);
    else
      return {std::numeric_limits<double>::quiet_NaN()};
  }
  std::unique_ptr<Seam> build(Arguments... arguments) const override {
    return std::make_unique<Product>(values_, arguments...);
  }

 private:
  Settings values_;
};

template <class... Seam>
struct CatalogEntry {
  std::string name;     // lower case letters, digits, - and _
  std::string summary;  // one line, for lists
  std::function<std::unique_ptr<Factory<Seam...>>()> make;
};

using ScenarioEntry = CatalogEntry<Scenario, const NoiseKey&, const Kernels&>;
using FixtureEntry = CatalogEntry<FixtureRule>;

struct TrajectoryEntry : CatalogEntry<Trajectory, const Scenario&> {
  bool has_buttons = false;  // replays the button presses of a recorded device
};

// Degrees of freedom that a renderer uses: six if its outputs have RenderOutput::tool.
enum class DegreesOfFreedom { three, six };

// The parts of a frame that constrain the proxy or tool of a renderer.
// - points: all points of a cloud.
// - regions: only the regions of points with r_f above 0.
// - mesh: the triangles between neighbours in an organised frame, so the order of the points matters.
// - sheet: a sheet fitted to points in cells along the world's axes. A rotated scene, or one that is sent
//   more often, gives similar outputs but not the same bits.
// - nothing: points only push, and a HIP that is pressed deeper passes them.
// - oriented: all points, and the direction to the sensor matters. The image layout of a frame gives this
//   direction; without one a setting in the world's axes does. Forbidden regions are ignored.
// - resting_points: all points, but points that a new frame puts into the tool stay in it. Rounding therefore
//   decides when a moving surface passes through the tool.
enum class ContactModel { points, regions, mesh, sheet, nothing, oriented, resting_points };

struct RendererEntry : CatalogEntry<Renderer, double, const Kernels&> {  // the haptic rate in Hz
  DegreesOfFreedom degrees_of_freedom = DegreesOfFreedom::three;
  ContactModel contact_model = ContactModel::points;
  std::vector<FrameNeed> needs = {};  // runs whose frames lack them are refused
};

// --- entries from classes ---

template <class Product, class Settings, class... Seam>
std::unique_ptr<Factory<Seam...>> factory() {
  return std::make_unique<FactoryFor<Product, Settings, Seam...>>();
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
RendererEntry renderer_entry(std::string name, DegreesOfFreedom degrees_of_freedom,
                             ContactModel contact_model, std::string summary,
                             std::vector<FrameNeed> needs = {}) {
  return {{std::move(name), std::move(summary), factory<Product, Settings, Renderer, double, const Kernels&>},
          degrees_of_freedom,
          contact_model,
          std::move(needs)};
}

}  // namespace remote_touch
