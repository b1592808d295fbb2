#include "runners/evaluation/scorecard/benchmark.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <deque>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <typeinfo>

#include "analysis/trace/contact_measures.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/settings/changed_settings.h"
#include "runners/experiment/settings/json_parameters.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {
namespace {

Json read_object(const std::string& json, const std::string& label, const std::vector<std::string>& parts) {
  Json object = parse_json(json, label);
  if (!object.is_object()) throw InputError(label, "not an object: expected {...}");
  for (const auto& item : object.items())
    if (std::find(parts.begin(), parts.end(), item.key()) == parts.end())
      throw InputError(label + ": " + item.key(), "unknown: expected " + joined(parts, ", "));
  return object;
}

std::string text_of(const Json& object, const char* part, const std::string& label) {
  const Json found = object.value(part, Json());
  if (!found.is_string()) throw InputError(label + ": " + part, "missing: expected a text");
  return found.get<std::string>();
}

std::string object_of(const Json& object, const char* part, const std::string& label) {
  const Json found = object.value(part, Json());
  if (!found.is_object()) throw InputError(label + ": " + part, "missing: expected {...}");
  return found.dump();
}

// Returns the direction of a measure in a scene. "judged" is the measure's own direction. A scene may define
// a direction only for a measure without one: less force is better if nothing should be touched.
Better better_of(const Json& word, const std::string& measure, const std::string& label) {
  const Better own = direction_of(directions(), measure);
  if (word == "reported") return Better::neither;
  if (word == "judged" && own != Better::neither) return own;
  for (const auto& [name, better] :
       {std::pair("larger", Better::larger), {"smaller", Better::smaller}, {"near_zero", Better::near_zero}})
    if (word == name && (own == Better::neither || own == better)) return better;
  throw InputError(label + " = " + shown(word),
                   own == Better::neither ? "expected larger, smaller, near_zero, reported"
                                          : "the measure has its own direction (" +
                                                std::string(text_of(own)) + "): expected judged or reported");
}

Bound bound_of(const Json& json, const std::string& label) {
  Bound bound;
  read_parameters(json,
                  {{"measure", &bound.measure, 0, 0, "what is bounded"},
                   {"min", &bound.min, -1e12, 1e12, "lower end"},
                   {"max", &bound.max, -1e12, 1e12, "upper end"}},
                  label);
  return bound;
}

std::vector<Bound> bounds_of(const Json& success, const char* part, const std::string& rule) {
  const auto found = success.find(part);
  if (found == success.end()) return {};
  if (!found->is_array() || found->empty())
    throw InputError(rule + "." + part, "no list: expected a list of {\"measure\", \"min\", \"max\"}");
  std::vector<Bound> bounds;
  for (const Json& bound : *found) bounds.push_back(bound_of(bound, rule + "." + part));
  return bounds;
}

void add_measure(BenchmarkScene& scene, const std::string& name, Better better) {
  if (std::ranges::find(scene.measures, name, &BenchmarkScene::Judged::measure) == scene.measures.end())
    scene.measures.push_back({name, better});
}
void add_judged(BenchmarkScene& scene, const std::string& name) {
  add_measure(scene, name, direction_of(directions(), name));
}

// The symmetric rule of a scene in which the surface has to be held: one for balls, points and springs, see
// contact_measures.h.
std::vector<Bound> held_bounds(double tolerance_m) {
  return {{.measure = "max_contact_error", .max = tolerance_m},
          {.measure = "contact_force_fraction", .min = 0.9},
          {.measure = "contact_known_fraction", .min = 0.9}};
}

std::string held_meaning(double tolerance_m) {
  return formatted(
      "held: from %g s after the HIP got below the true surface on, the contact point is never more "
      "than %g mm from it, above or below, and there is a force in 90 %% of these ticks",
      kSettling_s, 1e3 * tolerance_m);
}

// Reads {"rule": "held", "tolerance_m", "bounds" and their "meaning"}. The bounds are added to those of the
// rule.
void read_held_rule(const Json& success, const std::string& rule, BenchmarkScene& scene) {
  if (success["rule"] != "held")
    throw InputError(rule + ".rule = " + shown(success["rule"]), "expected held");
  double tolerance_m = kScorecardRadius_m;
  Json own = success;
  for (const char* part : {"rule", "meaning", "bounds", "old_bounds"}) own.erase(part);
  read_parameters(own, {{"tolerance_m", &tolerance_m, 1e-6, 1, "how far off the surface the contact may be"}},
                  rule);
  scene.meaning = held_meaning(tolerance_m);
  scene.success = held_bounds(tolerance_m);
  if (!success.contains("bounds")) {
    if (success.contains("meaning"))
      throw InputError(rule + ".meaning", "is that of bounds, and there are none: expected bounds too");
    return;
  }
  scene.meaning += "; " + text_of(success, "meaning", rule);
  for (const Bound& bound : bounds_of(success, "bounds", rule)) scene.success.push_back(bound);
}

void read_rule(const Json& success, const std::string& rule, BenchmarkScene& scene) {
  if (success.contains("rule")) {
    read_held_rule(success, rule, scene);
    add_judged(scene, "rms_contact_error");
    for (const char* name : {"max_sink", "max_float"}) add_measure(scene, name, Better::neither);
    return;
  }
  if (success.contains("tolerance_m"))
    throw InputError(rule + ".tolerance_m", "is that of a rule, and there is none: expected rule = held too");
  scene.meaning = text_of(success, "meaning", rule);
  scene.success = bounds_of(success, "bounds", rule);
  if (scene.success.empty())
    throw InputError(rule + ".bounds", "missing: expected a list of {\"measure\", \"min\", \"max\"}");
}

// Reads the rule, and adds to it that every number of the output is finite: NaN, which breaks no other bound
// on forces, is no success.
void read_success(const Json& success, const std::string& rule, BenchmarkScene& scene) {
  scene.old_success = bounds_of(success, "old_bounds", rule);
  read_rule(success, rule, scene);
  scene.success.push_back({.measure = "non_finite_fraction", .max = 0});
  scene.meaning += "; every output is finite";
}

// Returns the name of a method or scene that is read from a file: the file's name without folder and ending.
// Result files have that name. Throws InputError if it has other characters than those allowed.
std::string name_in(const std::string& file, const char* kind) {
  const std::string name = std::filesystem::path(file).stem().string();
  const auto is_plain = [](unsigned char c) { return std::isalnum(c) || c == '-' || c == '_' || c == '.'; };
  if (name.empty() || !std::all_of(name.begin(), name.end(), is_plain))
    throw InputError(std::string(kind) + " " + file,
                     "expected letters, digits, '-', '_' and '.' for its name");
  return name;
}

// Returns name and JSON of an embedded method or scene, or of one in a file.
std::pair<std::string, std::string> found(std::span<const EmbeddedText> stored, const std::string& name,
                                          const char* kind) {
  std::vector<std::string> known;
  for (const EmbeddedText& text : stored) {
    if (name == text.name) return {name, text.json};
    known.emplace_back(text.name);
  }
  const std::string expected = "expected " + joined(known, ", ") + ", or a JSON file";
  if (!name.ends_with(".json")) throw InputError(std::string(kind) + " " + name, "unknown: " + expected);
  return {name_in(name, kind), read_text_file(name, expected)};
}

// Reads the methods or scenes with these names; no names: all stored ones. stored: the texts of data/, or a
// table in a test.
template <class Item, class Read>
std::vector<Item> chosen(std::span<const EmbeddedText> stored, const std::vector<std::string>& names,
                         const char* kind, Read&& read) {
  std::vector<Item> items;
  std::set<std::string> taken;
  for (const std::string& wanted : names) {
    const std::pair<std::string, std::string> text = found(stored, wanted, kind);
    if (!taken.insert(text.first).second)
      throw InputError(std::string(kind) + " " + text.first, "appears twice: expected once");
    const auto item = [&](const std::vector<std::string>&) { return read(text.first, text.second); };
    items.push_back(is_stored(stored, wanted) ? item({}) : with_file_in_refusal(wanted, {}, item));
    if (!is_stored(stored, wanted)) items.back().file = wanted;
  }
  if (!names.empty()) return items;
  for (const EmbeddedText& text : stored) items.push_back(read(text.name, text.json));
  return items;
}

// Returns the measures of a scene's sweep: those of its bounds, those it names, and one that describes the
// renderer in every tick.
std::vector<std::string> measured(const BenchmarkScene& scene) {
  std::vector<std::string> names;
  const auto add = [&names](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const Bound& bound : scene.success) add(bound.measure);
  for (const Bound& bound : scene.old_success) add(bound.measure);
  for (const BenchmarkScene::Judged& judged : scene.measures) add(judged.measure);
  add("mean_steps");
  return names;
}

// Adds the sections of a method to the experiment of a scene. Throws InputError for one that the scene has,
// too.
void add_sections(const Json& sections, const std::string& scene, const std::string& method, Json& run) {
  for (const auto& item : sections.items()) {
    if (run.contains(item.key()))
      throw InputError("method " + method + ": " + item.key(),
                       "scene " + scene + " has its own: expected it in one of them");
    run[item.key()] = item.value();
  }
}

// Sets the scene's tool in a method's renderer. Throws InputError if the method states another tool, because
// the card would then state a tool that was not run.
void bring_tool(const Json& tool, const std::string& scene, const std::string& method, Json& renderer) {
  for (const auto& item : tool.items()) {
    const Json stated = renderer.value(item.key(), item.value());
    if (stated != item.value())
      throw InputError("method " + method + ": renderer." + item.key() + " = " + shown(stated),
                       "scene " + scene + " has a tool of its own: expected none");
  }
  renderer.update(tool);
}

// Does the work of BenchmarkScene::sweep(). label: the subject of its errors.
Sweep sweep_of(const BenchmarkScene& scene, const Method& method, int replicates, const std::string& label) {
  const std::string& name = scene.name;
  Json run = parse_json(scene.experiment, label);
  if (run.contains("renderer"))
    throw InputError("scene " + name + ": experiment.renderer",
                     "set: expected none, because methods define it");
  if (run.contains("seed"))
    throw InputError("scene " + name + ": experiment.seed", "set: expected none, the scorecard has its own");
  run["renderer"] = parse_json(method.renderer, label);
  if (!method.sections.empty()) add_sections(parse_json(method.sections, label), name, method.name, run);
  if (!scene.tool.empty()) bring_tool(parse_json(scene.tool, label), name, method.name, run["renderer"]);
  run["seed"] = kScorecardSeed;
  // A sweep needs an axis. If the scene has its own noise, the axis is the seed with one value. There are
  // then as many runs as other scenes have with noise, so that the same number of pairs decides.
  const bool own_noise = scene.noise.empty();
  const auto noisy_levels = static_cast<int>(scorecard_noise_m().size()) - 1;
  const Json levels = own_noise ? Json::array({kScorecardSeed}) : Json(scorecard_noise_m());
  return Sweep::from_json(
      Json{{"title", name + " with " + method.name + ": " + scene.title},
           {"experiment", run},
           {"axes", {{{"parameter", own_noise ? "seed" : scene.noise}, {"values", levels}}}},
           {"replicates", own_noise ? noisy_levels * replicates : replicates},
           {"measures", measured(scene)}}
          .dump(),
      label);
}

// Returns the file whose text the refusal `line` is about; empty if that text is not from a file.
const std::string& file_of(const std::string& line, const BenchmarkScene& scene, const Method& method) {
  const Json tool = scene.tool.empty() ? Json::object() : parse_json(scene.tool, scene.name);
  for (const auto& item : tool.items())
    if (line.starts_with("renderer." + item.key() + " ")) return scene.file;
  const Json sections = method.sections.empty() ? Json::object() : parse_json(method.sections, method.name);
  for (const auto& item : sections.items())
    if (line.starts_with(item.key())) return method.file;
  return line.starts_with("renderer") || line.starts_with("method ") ? method.file : scene.file;
}

}  // namespace

const std::vector<double>& scorecard_noise_m() {
  static const std::vector<double> levels = {0, 0.0005, 0.001, 0.003, 0.005, 0.01};
  return levels;
}

Method read_method(const std::string& name, const std::string& json) {
  const std::string label = "method " + name;
  Json object =
      read_object(json, label, {"title", "renderer", "feedback", "fixtures", "frame_link", "registration"});
  Method method{name, text_of(object, "title", label), object_of(object, "renderer", label)};
  for (const char* part : {"title", "renderer"}) object.erase(part);
  if (!object.empty()) method.sections = object.dump();
  return method;
}

BenchmarkScene read_benchmark_scene(const std::string& name, const std::string& json) {
  const std::string label = "scene " + name;
  const Json object =
      read_object(json, label, {"title", "experiment", "tool", "noise", "measures", "success"});
  BenchmarkScene scene{
      name, text_of(object, "title", label), object_of(object, "experiment", label), {}, {}, {}, {}};
  if (object.contains("tool")) scene.tool = object_of(object, "tool", label);
  if (object.contains("noise")) scene.noise = text_of(object, "noise", label);
  const Json measures = parse_json(object_of(object, "measures", label), label);
  for (const auto& item : measures.items())
    scene.measures.push_back(
        {item.key(), better_of(item.value(), item.key(), label + ": measures." + item.key())});
  const std::string rule = label + ": success";
  read_success(read_object(object_of(object, "success", label), rule,
                           {"rule", "tolerance_m", "meaning", "bounds", "old_bounds"}),
               rule, scene);
  add_judged(scene, "jump_fraction_10");
  for (const char* perceived : {"jump_fraction_5", "jump_fraction_20", "packet_rate_5", "packet_rate_10",
                                "packet_rate_20", "max_relative_jump"})
    add_measure(scene, perceived, Better::neither);
  return scene;
}

Sweep BenchmarkScene::sweep(const Method& method, int replicates) const {
  const std::string label = "scene " + name + " with " + method.name;
  try {
    return sweep_of(*this, method, replicates, label);
  } catch (const InputError& error) {
    if (typeid(error) != typeid(InputError)) throw;
    const std::string line = without_subject(label, error.what());
    const std::string& refused_file = file_of(line, *this, method);
    const bool is_of_caller = line.starts_with("replicates");
    if (refused_file.empty() || is_of_caller) throw;
    throw FileRefusal(refused_file, line);
  }
}

std::string configuration(const std::vector<Method>& methods, const std::vector<BenchmarkScene>& scenes,
                          int replicates) {
  Json all = {{"replicates", replicates},
              {"noise_sigma_m", scorecard_noise_m()},
              {"seed", kScorecardSeed},
              {"tuned_seeds", {1, kLastTunedSeed}}};
  for (const Method& method : methods) {
    Json& json = all["methods"][method.name];
    json = parse_json(method.renderer, method.name);
    if (!method.sections.empty())
      json = Json{{"renderer", json}, {"sections", parse_json(method.sections, method.name)}};
  }
  for (const BenchmarkScene& scene : scenes) {
    Json& json = all["scenes"][scene.name];
    json["experiment"] = parse_json(scene.experiment, scene.name);
    if (!scene.tool.empty()) json["tool"] = parse_json(scene.tool, scene.name);
    if (!scene.noise.empty()) json["noise"] = scene.noise;
    for (const Bound& bound : scene.success) {
      Json limits = {{"measure", bound.measure}};
      if (std::isfinite(bound.min)) limits["min"] = bound.min;
      if (std::isfinite(bound.max)) limits["max"] = bound.max;
      json["success"].push_back(limits);
    }
  }
  return all.dump();
}

// Accepts the name of a renderer as a method with the renderer's defaults, unless a stored method has that
// name.
std::vector<Method> chosen_methods(const std::vector<std::string>& names) {
  const auto stored = embedded_methods();
  if (names.empty()) return chosen<Method>(stored, names, "method", read_method);
  std::vector<EmbeddedText> known(stored.begin(), stored.end());
  std::deque<std::string> texts;
  for (const RendererEntry& entry : renderers()) {
    if (is_stored(stored, entry.name)) continue;
    texts.push_back(Json{{"title", entry.summary}, {"renderer", {{"name", entry.name}}}}.dump());
    known.push_back({entry.name.c_str(), texts.back().c_str()});
  }
  return chosen<Method>(std::span<const EmbeddedText>(known), names, "method", read_method);
}

std::vector<BenchmarkScene> chosen_scenes(const std::vector<std::string>& names) {
  return chosen<BenchmarkScene>(embedded_scenes(), names, "scene", read_benchmark_scene);
}

}  // namespace remote_touch
