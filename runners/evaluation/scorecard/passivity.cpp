#include "runners/evaluation/scorecard/passivity.h"

#include <nlohmann/json.hpp>
#include <set>

#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/settings/json_parameters.h"

namespace remote_touch {

namespace {

constexpr double kDamper_Ns_per_m = 3;

// Returns all parameters of the renderer; those that are left out have their defaults.
Json complete(const Json& renderer) {
  auto factory = find_entry(renderers(), renderer.at("name").get<std::string>(), "renderer.name").make();
  read_parameters(renderer, factory->settings(), "renderer", {"name"});
  Json all = {{"name", renderer.at("name")}};
  write_parameters(factory->settings(), all);
  return all;
}

// Returns the method with one parameter changed, or the method itself if the parameter has that value
// already.
Method with(const Method& method, const char* parameter, const Json& value, const std::string& mark) {
  Json renderer = parse_json(method.renderer, method.name);
  if (complete(renderer).at(parameter) == value) return method;
  renderer[parameter] = value;
  return {method.name + "+" + mark, method.title + ", " + parameter + " = " + value.dump(), renderer.dump()};
}

}  // namespace

std::vector<Method> force_laws_of(const Method& method) {
  std::vector<Method> laws;
  std::set<std::string> complete_laws;
  const auto add = [&](Method law) {
    if (complete_laws.insert(complete(parse_json(law.renderer, law.name)).dump()).second)
      laws.push_back(std::move(law));
  };
  const Json own = complete(parse_json(method.renderer, method.name));
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

}  // namespace remote_touch
