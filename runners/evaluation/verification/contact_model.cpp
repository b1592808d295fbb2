#include "runners/evaluation/verification/metamorphic_checks.h"

#include <map>
#include <utility>

namespace remote_touch {
namespace {

// The built-in renderers that not all checks apply to.
constexpr std::pair<const char*, ContactModel> kBuiltIn[] = {
    {"averaged-proxy", ContactModel::oriented},
    {"god-object", ContactModel::mesh},
    {"mls-surface", ContactModel::oriented},
    {"penalty", ContactModel::nothing},
    {"sphere-tree", ContactModel::regions},
    {"surfels", ContactModel::oriented},
    {"tool-god-object", ContactModel::resting_points},
    {"tracked-sheet", ContactModel::sheet},
    {"tracked-tool", ContactModel::sheet}};

// A static of a function: programs may declare models before main() begins.
std::map<std::string, ContactModel>& declared() {
  static std::map<std::string, ContactModel> models;
  return models;
}

}  // namespace

ContactModel contact_model_of(const std::string& renderer) {
  for (const auto& [name, model] : kBuiltIn)
    if (renderer == name) return model;
  const auto found = declared().find(renderer);
  return found == declared().end() ? ContactModel() : found->second;
}

void declare_contact_model(const std::string& renderer, const ContactModel& model) {
  declared().insert_or_assign(renderer, model);
}

}  // namespace remote_touch
