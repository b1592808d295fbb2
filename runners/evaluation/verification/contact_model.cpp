#include "runners/evaluation/verification/contact_model.h"

#include <map>

namespace remote_touch {
namespace {

using Models = std::map<std::string, ContactModel>;

// The built-in renderers that not all checks apply to.
const Models& built_in_models() {
  static const Models models = {
      {"averaged-proxy", ContactModel::oriented},
      {"god-object", ContactModel::mesh},
      {"mls-surface", ContactModel::oriented},
      {"penalty", ContactModel::nothing},
      {"sphere-tree", ContactModel::regions},
      {"surfels", ContactModel::oriented},
      {"tool-god-object", ContactModel::resting_points},
      {"tracked-sheet", ContactModel::sheet},
      {"tracked-tool", ContactModel::sheet},
  };
  return models;
}

Models& declared_models() {
  static Models models;
  return models;
}

}  // namespace

ContactModel contact_model_of(const std::string& renderer) {
  for (const Models* models : {&built_in_models(), static_cast<const Models*>(&declared_models())})
    if (const auto found = models->find(renderer); found != models->end()) return found->second;
  return {};
}

void declare_contact_model(const std::string& renderer, const ContactModel& model) {
  declared_models().insert_or_assign(renderer, model);
}

}  // namespace remote_touch
