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

#include "analysis/trace/measures.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/catalog/factory.h"

namespace remote_touch {

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
