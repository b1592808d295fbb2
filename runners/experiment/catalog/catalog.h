// Everything that an experiment can name, and the measures of its trace. A new scenario, fixture rule,
// trajectory or renderer of this project is one file pair and one line in catalog.cpp; a program of yours
// adds its own to built_in_catalog(), see runners/interfaces/cli/program.h. The contract tests
// (runners/evaluation/contract) then check it.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/measures/measures.h"
#include "core/beyond/tracked_surface/tracked_sheet_renderer.h"
#include "core/dissertation/proxy/proxy_step.h"
#include "core/parameters/input_error.h"
#include "core/rivals/god_object_renderer.h"
#include "core/rivals/implicit_surface_renderer.h"
#include "core/rivals/mls_surface_renderer.h"
#include "core/rivals/penalty_renderer.h"
#include "core/rivals/proxy_variants.h"
#include "core/rivals/surfel_renderer.h"
#include "runners/experiment/catalog/factory.h"

namespace remote_touch {

// The rest distance of each renderer: how far its position is from the surface that it touches, see
// factory.h. A new renderer adds one function here; tests/runners/experiment/catalog/
// catalog_test.cpp presses it on a flat cloud.

// Spacing of the points of most scenes (Grid). The surface of metaballs depends on the spacing, and their
// rest distance is computed for this one. If the points of a scene are closer or wider apart, the difference
// counts as an error of the method.
inline constexpr double kReferenceSpacing_m = 0.0015;

inline RenderedContact rendered_contact(const ProxyParameters& p) {
  return {p.contact_radius_m(), 0, p.contact_radius_m()};
}
// A sheet that is fitted to the points holds the ball, also between the points, so ball_radius_m is 0.
inline RenderedContact rendered_contact(const TrackedSheetParameters& p) {
  return {p.proxy.contact_radius_m()};
}
inline RenderedContact rendered_contact(const OracleProxyParameters& p) {
  return rendered_contact(p.proxy);
}
inline RenderedContact rendered_contact(const AveragedProxyParameters& p) {
  return rendered_contact(p.proxy);
}
// This renderer reports the position of a ball with the nominal radius, whatever its current radius is. The
// current radius grows with the spacing of the points, so that the ball does not fall through between them:
// ball_radius_m is 0.
inline RenderedContact rendered_contact(const DensityProxyParameters& p) {
  return {p.proxy.contact_radius_m()};
}
inline RenderedContact rendered_contact(const SurfelParameters&) {
  return {};
}
inline RenderedContact rendered_contact(const MlsSurfaceParameters&) {
  return {};
}
inline RenderedContact rendered_contact(const PenaltyParameters& p) {
  return {p.contact_radius_m, p.stiffness_N_per_m};
}
inline RenderedContact rendered_contact(const GodObjectParameters& p) {
  return {p.surface_offset_m};
}
// The rest distance of surfels is 0, because they lie in the plane of the points. Metaballs lie around the
// points: at the height h R over a plane of points of spacing s, the sum of the weights is pi R^2 / s^2 times
// the integral of w(q) over q^2, from h^2 to 1. The rest distance is the height at which this sum is T, found
// by bisection. It is 0 if the sum is less than T even on the plane.
RenderedContact rendered_contact(const ImplicitSurfaceParameters& p);
// Tools have no function here: their rest distance is not known, because a tool has a shape and not a radius.

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
