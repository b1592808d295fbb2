#include <cstdio>

#include "runners/cli/commands.h"
#include "runners/experiment/catalog.h"
#include "runners/experiment/experiment.h"
#include "runners/experiment/sections.h"
#include "runners/figures/figures.h"
#include "runners/scorecard/benchmark.h"
#include "runners/sweep/sweep.h"

namespace remote_touch {

namespace {
void row(const char* name, const std::string& text) {
  std::printf("  %-18s %s\n", name, text.c_str());
}
}  // namespace

int command_list(const CommandLine&, const ListRequest&) {
  std::puts("sections");
  for (const auto& section : experiment_sections()) row(section.key, section.summary);
  for (const auto& section : experiment_sections()) {
    if (!section.heading) continue;
    std::puts(section.heading);
    for (const auto& entry : section.entries()) row(entry.name.c_str(), entry.summary);
  }
  std::puts("experiments");
  for (const auto& stored : embedded_experiments())
    row(stored.name, Experiment::load(stored.name).settings().title);
  std::puts("sweeps");
  for (const auto& stored : embedded_sweeps()) row(stored.name, Sweep::load(stored.name).title());
  std::puts("methods");
  for (const Method& method : chosen_methods({})) row(method.name.c_str(), method.title);
  std::puts("scenes");
  for (const BenchmarkScene& scene : chosen_scenes({})) row(scene.name.c_str(), scene.title);
  std::puts("figures");
  for (const auto& entry : figures()) row(entry.name, entry.summary);
  std::puts("measures");
  for (const auto& measure : measures())
    row(measure.name.c_str(), measure.meaning + "; unit: " + measure.unit + "; " + name_of(measure.runs));
  return kDone;
}

}  // namespace remote_touch
