#include "runners/experiment/provenance/recipe.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/parameters/input_error.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/experiment/provenance/shell_command.h"
#include "scenarios/text_files/json_text.h"

namespace remote_touch {

namespace {

using Words = std::vector<std::string>;

void add_options(Words& words, const char* option, const Words& values) {
  for (const std::string& value : values) words.insert(words.end(), {option, value});
}

std::string cell_text(const Recipe& recipe) {
  std::string text;
  for (const std::size_t place : recipe.cell)
    text.append(text.empty() ? "" : ",").append(std::to_string(place));
  return text;
}

// Accepts integers only. The library would convert any number.
void take_integer(const Json& json, const char* name, int& value) {
  const auto found = json.find(name);
  if (found == json.end()) return;
  const auto number = found->is_number_integer() ? found->get<std::int64_t>() : -1;
  if (number < 0 || number > std::numeric_limits<int>::max())
    throw InputError(std::string(kRecipe) + "." + name, "expected an integer");
  value = static_cast<int>(number);
}

void take_cell(const Json& json, std::vector<std::size_t>& cell) {
  const auto found = json.find("cell");
  if (found == json.end()) return;
  for (const Json& place : found->get_ref<const Json::array_t&>()) {
    if (!place.is_number_unsigned()) throw InputError(std::string(kRecipe) + ".cell", "expected integers");
    cell.push_back(place.get<std::size_t>());
  }
}

Recipe recipe_in(const Json& json) {
  Recipe recipe{json.at("action").get<std::string>(), json.at("subject").get<std::string>()};
  recipe.overrides = json.value("set", Words()), recipe.tolerances = json.value("tolerances", Words());
  recipe.candidate = json.value("candidate", std::string());
  take_cell(json, recipe.cell);
  take_integer(json, "replicate", recipe.replicate), take_integer(json, "coarse", recipe.coarse);
  return recipe;
}

bool is_known(const std::string& action) {
  constexpr const char* kActions[] = {"run", "sweep", "replay", "figure", "compare"};
  return std::find(std::begin(kActions), std::end(kActions), action) != std::end(kActions);
}

}  // namespace

std::vector<Words> commands(const Recipe& recipe) {
  const bool is_replay = recipe.action == "replay";
  Words words = program_words();
  words.insert(words.end(), {is_replay ? "sweep" : recipe.action, recipe.subject});
  if (recipe.action == "compare") words.push_back(recipe.candidate);
  add_options(words, "--set", recipe.overrides);
  add_options(words, "--tolerance", recipe.tolerances);
  if (recipe.coarse != 1) add_options(words, "--coarse", {std::to_string(recipe.coarse)});
  if (!is_replay) return {words};
  Words again = program_words();
  again.insert(again.end(),
               {"replay", "--cell", cell_text(recipe), "--replicate", std::to_string(recipe.replicate)});
  return {words, again};
}

std::string command_text(const Recipe& recipe) {
  std::string text;
  for (const Words& words : commands(recipe))
    text.append(text.empty() ? "" : "; ").append(shell_command(words));
  return text;
}

std::string to_json(const Recipe& recipe) {
  Json json = {{"action", recipe.action}, {"subject", recipe.subject}};
  if (!recipe.overrides.empty()) json["set"] = recipe.overrides;
  if (recipe.action == "replay") json["cell"] = recipe.cell, json["replicate"] = recipe.replicate;
  if (recipe.coarse != 1) json["coarse"] = recipe.coarse;
  if (recipe.action == "compare") json["candidate"] = recipe.candidate;
  if (!recipe.tolerances.empty()) json["tolerances"] = recipe.tolerances;
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);  // names of files need not be UTF-8
}

std::optional<Recipe> recipe_of(const TextAttributes& attributes) {
  try {
    const Json json = json_or_none(attribute(attributes, kRecipe), kRecipe).value_or(Json());
    Recipe recipe = recipe_in(json);
    if (is_known(recipe.action)) return recipe;
  } catch (const Json::exception&) {  // a field is missing, or of another kind
  } catch (const InputError&) {
  }
  return {};
}

}  // namespace remote_touch
