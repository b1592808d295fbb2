// Factory of a catalog entry: settings that can be read, listed and validated, and from which the object is
// built.
#pragma once

#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "core/random/noise.h"
#include "core/rendering/renderer.h"
#include "core/virtual_fixtures/fixture_rule.h"
#include "runners/trajectories/trajectory.h"
#include "scenarios/interface/scenario.h"
#include "scenarios/recordings/recording_part.h"

namespace remote_touch {

// Settings that can be read, listed and checked.
class Configurable {
 public:
  virtual ~Configurable() = default;
  virtual Parameters settings() = 0;         // pointers into this object
  virtual std::string validate() const = 0;  // "r1_m = 1: expected ..."; empty: they fit together
};

template <class Seam, class... Arguments>
class Factory : public Configurable {
 public:
  virtual std::vector<RecordingPart> inputs() const = 0;  // the files that the settings name; mostly none
  // Of a renderer: no pose makes its force grow faster with the device's displacement. 0 for all others.
  virtual double stiffness_N_per_m() const = 0;
  virtual std::unique_ptr<Seam> build(Arguments... arguments) const = 0;
};

// For a product with a constructor (Settings, Arguments...) and functions parameters(Settings&),
// validate(Settings); max_stiffness_N_per_m(Settings) of every renderer; and input_files(Settings) where the
// settings name files.
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
  std::unique_ptr<Seam> build(Arguments... arguments) const override {
    return std::make_unique<Product>(values_, arguments...);
  }

 private:
  Settings values_;
};

template <class... Seam>
struct CatalogEntry {
  const char* name;
  const char* summary;
  std::unique_ptr<Factory<Seam...>> (*make)();
};

using ScenarioEntry = CatalogEntry<Scenario, const NoiseKey&, const Kernels&>;
using FixtureEntry = CatalogEntry<FixtureRule>;

struct TrajectoryEntry : CatalogEntry<Trajectory, const Scenario&> {
  bool has_buttons = false;  // the hand presses those of the device that it was recorded with
};

// Of the hand that a renderer is for: six where its outputs have RenderOutput::tool.
enum class DegreesOfFreedom { three, six };

// What a renderer is held by: all points of a cloud, the regions of those with r_f above 0 alone, the
// triangles between neighbours in an organised frame, for which the order of the points matters, a sheet that
// is fitted to points in cells along the world's axes, so that a scene that is turned or sent more often is
// answered alike and not to the last bit, or nothing: it is pushed by points, and passes them when it is
// pressed deeper than they push.
enum class ContactModel { points, regions, mesh, sheet, nothing };

struct RendererEntry : CatalogEntry<Renderer, double, const Kernels&> {  // the haptic rate in Hz
  DegreesOfFreedom degrees_of_freedom = DegreesOfFreedom::three;
  ContactModel contact_model = ContactModel::points;
};

}  // namespace remote_touch
