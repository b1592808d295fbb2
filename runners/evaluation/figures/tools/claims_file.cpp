#include "runners/evaluation/figures/tools/claims_file.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "analysis/storage/atomic_file.h"
#include "scenarios/text_files/text_file.h"

namespace remote_touch {

namespace {

Json claim_json(const Claim& claim) {
  const Json none;
  return {{"figure", claim.figure},
          {"claim", claim.claim},
          {"paper", claim.paper},
          {"source", claim.source},
          {"measured", std::isfinite(claim.measured) ? Json(claim.measured) : none},
          {"criterion", claim.criterion},
          {"unit", claim.unit},
          {"verdict", verdict_name(claim.verdict)},
          {"set_up", claim.set_up}};
}

}  // namespace

ClaimsFile::ClaimsFile(std::filesystem::path file, std::vector<std::string> order)
    : file_(std::move(file)),
      order_(std::move(order)),
      claims_(std::make_unique<std::vector<Json>>(order_.size() + 1, Json::array())) {
  require_writable(file_);                   // checked first, because reading a pipe would wait for a writer
  const Json earlier = json_in_file(file_);  // if absent or damaged, there is nothing to keep
  if (!earlier.is_array()) return;
  for (const auto& claim : earlier) {
    const auto name = claim.is_object() ? claim.find("figure") : claim.end();
    if (name == claim.end() || !name->is_string()) continue;
    const auto place = std::find(order_.begin(), order_.end(), name->get<std::string>());
    (*claims_)[static_cast<std::size_t>(place - order_.begin())].push_back(claim);
  }
}

ClaimsFile::~ClaimsFile() = default;

void ClaimsFile::replace(const std::string& figure, std::span<const Claim> claims) {
  const auto place = std::find(order_.begin(), order_.end(), figure);
  Json& own = (*claims_)[static_cast<std::size_t>(place - order_.begin())];
  own = Json::array();
  for (const Claim& claim : claims) own.push_back(claim_json(claim));
  Json all = Json::array();
  for (const Json& of_figure : *claims_) all.insert(all.end(), of_figure.begin(), of_figure.end());
  const std::string text = all.dump(2) + "\n";
  write_file_atomically(file_, text.data(), text.size());
}

}  // namespace remote_touch
