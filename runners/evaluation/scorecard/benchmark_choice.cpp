#include "runners/evaluation/scorecard/benchmark_choice.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/parameters/input_error.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/settings/json_parameters.h"

namespace remote_touch {

namespace {

// Returns of(method), which reads the method's renderer. If it throws InputError and the method is from a
// file, the message begins with the file name.
template <class Of>
bool with_file_of(const Method& method, Of of) {
  if (method.file.empty()) return of(method);
  return with_file_in_refusal(method.file, {}, [&](const std::vector<std::string>&) { return of(method); });
}

bool has_renderer_for_tools(const Method& method) {
  const std::string label = "method " + method.name + ": renderer";
  const Json renderer = parse_json(method.renderer, label);
  if (!renderer.contains("name") || !renderer["name"].is_string())
    throw InputError(label + ".name", "missing: expected a renderer");
  const std::string name = renderer["name"];
  return find_entry(renderers(), name, label + ".name").degrees_of_freedom == DegreesOfFreedom::six;
}

bool has_known_contact(const Method& method) {
  const Json renderer = parse_json(method.renderer, "method " + method.name);
  const auto factory = find_entry(renderers(), renderer.at("name").get<std::string>(), "renderer").make();
  read_parameters(renderer, factory->settings(), "method " + method.name + ": renderer", {"name"});
  return !std::isnan(factory->contact().rest_distance_m);
}

bool judges_contact(const BenchmarkScene& scene) {
  const auto is_of_contact = [](const Bound& bound) {
    return std::any_of(measures().begin(), measures().end(), [&](const Measure& measure) {
      return measure.name == bound.measure &&
             (measure.runs == MeasuredRuns::contact || measure.runs == MeasuredRuns::measured_surface);
    });
  };
  return std::any_of(scene.success.begin(), scene.success.end(), is_of_contact);
}

const char* words_of(Compared kind) {
  switch (kind) {
    case Compared::hip:
      return "for a HIP";
    case Compared::tools:
      return "for tools";
    case Compared::teleoperation:
      break;
  }
  return "of teleoperation";
}

// Throws InputError if a scene judges the contact of a renderer whose rest distance is not known. Its runs
// would count as failures.
void require_known_contact(const Benchmark& chosen) {
  for (const Method& method : chosen.methods) {
    if (compared(method) != Compared::hip || with_file_of(method, has_known_contact)) continue;
    for (const BenchmarkScene& scene : chosen.scenes)
      if (judges_contact(scene))
        throw InputError("method " + method.name,
                         "scene " + scene.name +
                             " judges contact by the renderer's rest distance, which is not known: expected "
                             "rendered_contact() of its settings, or rest_distance_m of a plug-in");
  }
}

}  // namespace

Compared compared(const Method& method) {
  if (!method.sections.empty()) return Compared::teleoperation;
  return with_file_of(method, has_renderer_for_tools) ? Compared::tools : Compared::hip;
}

Compared compared(const BenchmarkScene& scene) {
  if (!scene.tool.empty()) return Compared::tools;
  return parse_json(scene.experiment, scene.name).contains("slave") ? Compared::teleoperation : Compared::hip;
}

Benchmark chosen_benchmark(const std::vector<std::string>& methods, const std::vector<std::string>& scenes,
                           int replicates, const std::string& folder) {
  Benchmark chosen{chosen_methods(methods), chosen_scenes(scenes), replicates, folder};
  const Compared kind = !methods.empty()  ? compared(chosen.methods.front())
                        : !scenes.empty() ? compared(chosen.scenes.front())
                                          : Compared::hip;
  const auto fits = [kind](const auto& each) { return compared(each) == kind; };
  if (methods.empty()) std::erase_if(chosen.methods, [&](const Method& method) { return !fits(method); });
  if (scenes.empty()) std::erase_if(chosen.scenes, [&](const BenchmarkScene& scene) { return !fits(scene); });
  const std::string expected = std::string("expected only those ") + words_of(kind) + ", like the first";
  for (const Method& method : chosen.methods)
    if (!fits(method)) throw InputError("method " + method.name, expected);
  for (const BenchmarkScene& scene : chosen.scenes)
    if (!fits(scene)) throw InputError("scene " + scene.name, expected);
  require_known_contact(chosen);
  return chosen;
}

}  // namespace remote_touch
