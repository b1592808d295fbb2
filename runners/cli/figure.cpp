#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "analysis/figures/result_file.h"
#include "analysis/storage/atomic_file.h"
#include "core/parameters/input_error.h"
#include "runners/cli/commands.h"
#include "runners/cli/progress.h"
#include "runners/figures/figures.h"
#include "runners/provenance/provenance.h"
#include "scenarios/recordings/recording_part.h"

namespace remote_touch {

namespace {

// Each once, in the order of the table.
std::vector<const FigureEntry*> chosen_figures(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const auto is_named = [&](const FigureEntry& entry) { return name == "all" || name == entry.name; };
    if (std::none_of(figures().begin(), figures().end(), is_named))
      throw InputError("figure " + name, "unknown: expected a name from `remote-touch list`");
  }
  std::vector<const FigureEntry*> chosen;
  for (const FigureEntry& entry : figures()) {
    const auto names_it = [&](const std::string& name) { return name == "all" || name == entry.name; };
    if (std::any_of(names.begin(), names.end(), names_it)) chosen.push_back(&entry);
  }
  return chosen;
}

bool is_judged(const Claim& claim) {
  return claim.verdict == Verdict::pass || claim.verdict == Verdict::fail;
}

nlohmann::ordered_json claim_json(const Claim& claim) {
  const nlohmann::ordered_json none;
  return {{"figure", claim.figure},
          {"claim", claim.claim},
          {"paper", claim.paper},
          {"measured", std::isfinite(claim.measured) ? nlohmann::ordered_json(claim.measured) : none},
          {"criterion", claim.criterion},
          {"unit", claim.unit},
          {"pass", is_judged(claim) ? nlohmann::ordered_json(claim.verdict == Verdict::pass) : none}};
}

void print(const Claim& claim) {
  const char* verdict = claim.verdict == Verdict::pass   ? "pass"
                        : claim.verdict == Verdict::fail ? "FAIL"
                        : claim.verdict == Verdict::open ? "open"
                                                         : "not run";
  std::printf("  %-7s %s: %.6g %s (%s)\n", verdict, claim.claim.c_str(), claim.measured, claim.unit.c_str(),
              claim.criterion.c_str());
}

// The claims that an earlier call left in the folder, of figures that are not made now.
nlohmann::ordered_json other_claims(const std::filesystem::path& file,
                                    const std::vector<const FigureEntry*>& chosen) {
  nlohmann::ordered_json kept = nlohmann::ordered_json::array();
  std::ifstream in(file);
  const auto earlier =
      nlohmann::ordered_json::parse(in, nullptr, false);  // absent or damaged: nothing to keep
  if (!earlier.is_array()) return kept;
  for (const auto& claim : earlier) {
    const auto name = claim.is_object() ? claim.find("figure") : claim.end();
    if (name == claim.end() || !name->is_string()) continue;
    const std::string figure = *name;
    const auto is_made = [&](const FigureEntry* entry) { return figure == entry->name; };
    if (std::none_of(chosen.begin(), chosen.end(), is_made)) kept.push_back(claim);
  }
  return kept;
}

std::string figure_command(const std::string& name, int coarse) {
  const std::string whole = "remote-touch figure " + name;
  return coarse == 1 ? whole : whole + " --coarse " + std::to_string(coarse);
}

// A share of a coarse map is not that of the whole.
void leave_unjudged(Figure& figure, int coarse) {
  figure.caption += " Coarse: about one in " + std::to_string(coarse) +
                    " values of each axis of the maps, so no claim is judged.";
  for (Claim& claim : figure.claims) {
    claim.verdict = Verdict::open;
    claim.criterion += ", not judged on a coarse map";
  }
}

// A recording that is not there is no failure of the method: the claim says so and the rest goes on.
Figure make(const FigureEntry& entry, const FigureContext& context) {
  try {
    return entry.make(context);
  } catch (const MissingRecording& error) {
    Figure figure{entry.name, "Not run", std::string("Not run: ") + error.what()};
    figure.claims = {claim_not_run(entry.name, entry.summary, error.what())};
    return figure;
  }
}

}  // namespace

int command_figure(const CommandLine& line, const FigureRequest& request) {
  const auto chosen = chosen_figures(request.names);
  std::error_code failure;
  std::filesystem::create_directories(request.folder, failure);
  if (failure)
    throw InputError(request.folder,
                     "cannot be made (" + failure.message() + "): expected a writable folder");

  const auto claims_file = std::filesystem::path(request.folder) / "claims.json";
  nlohmann::ordered_json claims = other_claims(claims_file, chosen);
  bool all_hold = true;
  for (const FigureEntry* entry : chosen) {
    Progress progress(std::string("figure ") + entry->name, line.quiet);
    const FigureContext context(
        *line.kernels, line.stop, [&](double fraction) { progress.update(fraction); }, request.coarse);
    Figure figure = make(*entry, context);
    const bool is_coarse = context.has_coarse_map();
    if (is_coarse) leave_unjudged(figure, request.coarse);
    const auto file = std::filesystem::path(request.folder) / ("fig" + figure.name + ".h5");
    write_figure(
        file, figure,
        provenance(context.configurations(), figure_command(figure.name, is_coarse ? request.coarse : 1),
                   line.kernels->isa, context.inputs()));
    std::printf("figure %s -> %s\n", figure.name.c_str(), file.string().c_str());
    for (const Claim& claim : figure.claims) {
      print(claim);
      claims.push_back(claim_json(claim));
      all_hold &= claim.verdict != Verdict::fail;
    }
    const std::string text = claims.dump(2) + "\n";  // after each figure: an interruption keeps what is done
    write_file_atomically(claims_file, text.data(), text.size());
  }
  return all_hold ? kDone : kCheckFailed;
}

}  // namespace remote_touch
