// Factories of catalog entries: they hold settings and build the object from them.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "core/kernels/kernels.h"
#include "core/numeric/noise.h"
#include "core/parameters/parameter.h"
#include "core/rendering/frame.h"
#include "core/rendering/renderer.h"
#include "runners/experiment/hand/trajectory.h"
#include "scenarios/interface/scenario.h"
#include "scenarios/recordings/recording.h"

namespace remote_touch {

// The contact point of a renderer, and its height above the true surface: the quantity by which a ball, a
// point and a spring without a proxy are compared.
//
// The centre of a ball in contact is r_c above the surface, and a point proxy is on it. The height of the
// contact point is therefore
//
//   height = d(x) - rest distance,
//
// where x is the renderer's position and d the signed distance to the true surface, positive outside. For a
// ball it is the height of the point that faces the surface, because d is measured along the outward normal
// of the surface. The height is 0 where the rendered surface is the true one, positive where it floats above
// it and negative where it has sunk below it.
//
// A renderer with a proxy has x = RenderOutput::proxy_W, and a spring pulls the hand towards it. The depth of
// the hand does not matter. A penalty force has no proxy: the hand sinks until the spring holds it, as the
// hand of the other methods sinks below the proxy. This depth must not count either. x is therefore the
// position at which the force would end: x = HIP + F / k, with the force F of this tick and its stiffness k.
// The penalty force of the dissertation over a plane is F = k (r_c - d(HIP)) n, so d(x) = r_c and the height
// is 0, however deep the press is. Once the HIP has passed the points, F pushes it further, x is below the
// surface too, and the height is negative. Dampers are not considered, because no method of the scorecard has
// one.

struct RenderedContact {
  double rest_distance_m = 0;  // distance of x from a flat, noise-free surface in contact; NaN: not known
  double spring_N_per_m = 0;   // above 0: there is no proxy, and x = HIP + F / k with this k
  // Above 0: the proxy is a ball of this radius that single points hold, as in chapter 4, so that it falls
  // through between points that are too far apart. 0: something else holds the proxy, such as a mesh, or
  // there is no proxy.
  double ball_radius_m = 0;
};

// A contact point that has sunk less than this below the true surface has not passed through it, m: half the
// contact radius of 4.3. Noise tilts and shifts the surface that a renderer estimates, and moves it to both
// sides alike. A plane through the points within 10 mm at the spacing of most scenes, 1.5 mm, has 140 points,
// so that even noise of r_c = 5 mm shifts it by 0.42 mm (standard deviation), a sixth of this.
inline constexpr double kMinSink_m = 0.0025;

// Returns the distance, m, by which x may lie behind the true surface and still count as held in front of it.
// A ball counts as held until its centre is behind the surface: it has then sunk by its rest distance. A
// position that rests on the surface, or nearly, would be behind it by rounding alone, so it may sink by
// kMinSink_m. Returns 0 if the rest distance is not known.
inline double held_depth_m(const RenderedContact& contact) {
  return std::isnan(contact.rest_distance_m) ? 0 : std::max(0.0, kMinSink_m - contact.rest_distance_m);
}

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

// A contact model says which checks of the contract tests and of `verify` apply to a renderer. It does not
// change runs. All values are false for a proxy that is held by all points of a cloud and by the forbidden
// regions around them: every check applies to it. Each true value changes or omits checks.
struct ContactModel {
  // The contract tests give every point a region; `verify` gives a tool only scenes with regions, and mirrors
  // none.
  bool renders_only_regions = false;
  // Points only push: three contract tests hold the HIP 2 to 3 mm above the points.
  bool pressed_hip_passes_through = false;
  bool may_lose_contact = false;        // `touch` asks for a force in 2 % of the ticks, not in half of them
  bool depends_on_point_order = false;  // `verify` does not reorder the points
  bool uses_camera = false;  // `verify` keeps the image layout, which gives the direction to the sensor
  // `verify` does not mirror the scene. It moves only images of a renderer that uses the camera, and doubles
  // the frame rate only if the renderer uses the camera.
  bool depends_on_axes = false;
  bool smooths_creases = false;  // `verify` gives a tool no scene in which walls meet
  // `verify` gives a tool no moving cloud, because rounding decides when the surface passes through the tool.
  bool motion_amplifies_rounding = false;

  // The named models. The name says what holds the proxy; runners/interfaces/plugins/remote_touch_plugin.h
  // gives reasons.
  // NOLINTNEXTLINE(readability-identifier-naming): these are the names of plug-ins and Python.
  static const ContactModel points, regions, mesh, sheet, nothing, oriented, resting_points;
};
inline constexpr ContactModel ContactModel::points{};
inline constexpr ContactModel ContactModel::regions{.renders_only_regions = true};
inline constexpr ContactModel ContactModel::mesh{.may_lose_contact = true, .depends_on_point_order = true};
inline constexpr ContactModel ContactModel::sheet{.depends_on_axes = true, .smooths_creases = true};
inline constexpr ContactModel ContactModel::nothing{.pressed_hip_passes_through = true,
                                                    .may_lose_contact = true};
inline constexpr ContactModel ContactModel::oriented{
    .may_lose_contact = true, .uses_camera = true, .depends_on_axes = true};
inline constexpr ContactModel ContactModel::resting_points{.motion_amplifies_rounding = true};

// The named models, indexed by their number in plug-ins. Python lists the names in the same order.
inline constexpr ContactModel kContactModels[] = {
    ContactModel::points,  ContactModel::regions,  ContactModel::mesh,          ContactModel::sheet,
    ContactModel::nothing, ContactModel::oriented, ContactModel::resting_points};

struct RendererEntry : CatalogEntry<Renderer, double, const Kernels&> {  // the haptic rate in Hz
  DegreesOfFreedom degrees_of_freedom = DegreesOfFreedom::three;
  ContactModel contact_model = {};
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
