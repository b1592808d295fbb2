#include "runners/evaluation/scorecard/benchmark.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "analysis/trace/columns.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/settings/json_parameters.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/sweep/sweep_session.h"
#include "scenarios/recordings/recording.h"

namespace remote_touch {
namespace {

constexpr double kDamper_Ns_per_m = 3;

// Returns all parameters of the method's renderer; those that are left out have their defaults.
Json complete(const Method& method) {
  const Json renderer = parse_json(method.renderer, method.name);
  auto factory = find_entry(renderers(), renderer.at("name").get<std::string>(), "renderer.name").make();
  read_parameters(renderer, factory->settings(), "renderer", {"name"});
  Json all = {{"name", renderer.at("name")}};
  write_parameters(factory->settings(), all);
  return all;
}

// Returns the method with one parameter changed, or the method itself if the parameter has that value
// already.
Method with(const Method& method, const char* parameter, const Json& value, const std::string& mark) {
  if (complete(method).at(parameter) == value) return method;
  Json renderer = parse_json(method.renderer, method.name);
  renderer[parameter] = value;
  return {method.name + "+" + mark, method.title + ", " + parameter + " = " + value.dump(), renderer.dump()};
}

// The sweeps of all methods in a scene, in order. Throws MissingInput for a scene whose recording is not
// on this machine, InputError for a sweep that cannot be run.
std::vector<BenchmarkSweep> sweeps_of(const Benchmark& benchmark, const BenchmarkScene& scene) {
  std::vector<BenchmarkSweep> sweeps;
  for (const Method& method : benchmark.methods) {
    Sweep sweep = scene.sweep(method, benchmark.replicates);
    const std::string name = scene.name + "." + method.name;
    // Makes the file again, in any folder.
    const std::string command = program_text() + " scorecard " + method.name + " --scene " + scene.name +
                                " --seeds " + std::to_string(benchmark.replicates);
    TextAttributes attributes = provenance(sweep.to_json(), command, "", input_hashes(sweep.inputs()));
    sweeps.push_back(
        {name, std::move(sweep), std::move(attributes), benchmark.folder / "runs" / (name + ".h5")});
  }
  return sweeps;
}

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
  return kind == Compared::hip ? "for a HIP" : kind == Compared::tools ? "for tools" : "of teleoperation";
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

std::vector<Method> force_laws_of(const Method& method) {
  std::vector<Method> laws;
  std::set<std::string> complete_laws;
  const auto add = [&](Method law) {
    if (complete_laws.insert(complete(law).dump()).second) laws.push_back(std::move(law));
  };
  const Json own = complete(method);
  add(method);
  // The velocity term is zero without an estimate, whatever its sign.
  if (own.contains("velocity_force") && own.value("velocity_estimate", true))
    for (const char* sign : {"minus", "plus", "none"})
      add(with(method, "velocity_force", sign, std::string("v_") + sign));
  if (!own.contains("damping_Ns_per_m")) return laws;
  const std::vector<Method> with_own_damper = laws;
  for (const Method& law : with_own_damper) {
    add(with(law, "damping_Ns_per_m", 0.0, "k_d0"));
    add(with(law, "damping_Ns_per_m", kDamper_Ns_per_m, "k_d3"));
  }
  if (!own.contains("damping_sign")) return laws;
  for (const Method& law : with_own_damper)
    for (const char* sign : {"plus", "minus"})
      add(with(with(law, "damping_Ns_per_m", kDamper_Ns_per_m, "k_d3"), "damping_sign", sign,
               std::string("k_d_") + sign));
  return laws;
}

std::vector<BenchmarkSweep> BenchmarkPlan::sweeps() const {
  std::vector<BenchmarkSweep> list;
  for (const ScenePlan& one : scenes) list.insert(list.end(), one.sweeps.begin(), one.sweeps.end());
  // A method's own force law is also in the audit, with the same file, so it is listed once.
  for (const ScenePlan& scene : audit)
    for (const BenchmarkSweep& one : scene.sweeps)
      if (std::none_of(list.begin(), list.end(),
                       [&](const BenchmarkSweep& other) { return other.name == one.name; }))
        list.push_back(one);
  return list;
}

BenchmarkPlan plan_of(const Benchmark& benchmark) {
  BenchmarkPlan plan;
  plan.benchmark = benchmark;
  for (const BenchmarkScene& scene : plan.benchmark.scenes) {
    try {
      plan.scenes.push_back({scene, sweeps_of(plan.benchmark, scene)});
    } catch (const MissingInput& missing) {
      plan.skipped.emplace_back(scene.name, missing.what());
      continue;
    }
    if (std::ranges::find(kPassivityScenes, scene.name) == std::end(kPassivityScenes)) continue;
    if (plan.laws.empty())
      for (const Method& method : plan.benchmark.methods)
        for (Method& law : force_laws_of(method)) plan.laws.push_back(std::move(law));
    Benchmark audit = plan.benchmark;
    audit.methods = plan.laws;
    plan.audit.push_back({scene, sweeps_of(audit, scene)});
  }
  return plan;
}

void require_same_benchmark(const std::vector<BenchmarkSweep>& sweeps) {
  for (const BenchmarkSweep& one : sweeps) plan_in_file(one.sweep, {}, one.attributes, one.file);
}

void do_sweeps(const std::vector<BenchmarkSweep>& sweeps, const Kernels& kernels,
               const std::atomic<bool>* stop, const BenchmarkProgress& progress) {
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    progress(i, sweeps.size(), 0);
    SweepSession session(sweeps[i].sweep, {}, sweeps[i].attributes, sweeps[i].file);
    session.run(kernels, stop, [&](std::size_t done, std::size_t total, std::size_t) {
      progress(i, sweeps.size(), static_cast<double>(done) / static_cast<double>(total));
    });
  }
}

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
