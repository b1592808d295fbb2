// Reads the origin that a result states: recipe, hashes of inputs, configuration. The input is two texts,
// separated by a line "---".
#include "runners/experiment/settings/provenance.h"
#include "runners/experiment/settings/changed_settings.h"
#include "tests/fuzz/shared/content_text.h"
#include "tests/fuzz/shared/fuzz_target.h"

namespace remote_touch::fuzz::provenance {
namespace {

void read(std::string_view bytes) {
  const auto [first, second] = two_parts(bytes);
  const std::string a(first), b(second);
  if (const auto recipe = recipe_of({{kRecipe, a}})) {
    command_text(*recipe);
    require(recipe_of({{kRecipe, to_json(*recipe)}}).has_value(), "a recipe survives writing and reading");
  }
  require(changed_inputs(a, b).empty() == changed_inputs(b, a).empty(), "a difference is one both ways");
  require(changed_inputs(a, a).empty(), "a text does not differ from itself");
  accepts(bytes, [&] { require(configuration_differences(a, a).empty(), "a configuration is its own"); });
  accepts(bytes, [&] { configuration_differences(a, b); });
}

const Registered registered("provenance", read);

}  // namespace
}  // namespace remote_touch::fuzz::provenance
