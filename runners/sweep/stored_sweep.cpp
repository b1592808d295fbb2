#include "runners/sweep/stored_sweep.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "analysis/storage/hdf5_file.h"
#include "analysis/tally/tally_file.h"
#include "core/parameters/input_error.h"
#include "runners/experiment/settings/stored_configuration.h"
#include "runners/sweep/tally_outline.h"
#include "scenarios/text_files/json_text.h"

namespace remote_touch {

namespace {

// axis: its definition in the configuration, with present names. A definition that does not fit the column is
// ignored; Sweep::require_fits() refuses it.
void rename_axis(const Json& axis, Column& column) {
  if (!axis.is_object() || !axis.contains("parameter") || !axis["parameter"].is_string()) return;
  const std::string parameter = axis["parameter"].get<std::string>();
  if (column.long_name != parameter) {
    column.long_name = parameter;
    column.name = parameter.substr(parameter.rfind('.') + 1);
  }
  const auto values = axis.find("values");
  if (values == axis.end() || !values->is_array() || values->size() != column.value_names.size()) return;
  for (std::size_t i = 0; i < values->size(); ++i) {
    const Json& value = (*values)[i];
    column.value_names[i] = value.is_string() ? value.get<std::string>() : value.dump();
  }
}

constexpr std::size_t kMaxRunsInMemory = 10'000'000;

StoredSweep with_present_names(StoredSweep stored) {
  if (is_earlier_schema(stored.schema)) {
    stored.attributes.emplace_back(kTranslatedFrom, stored.schema);
    stored.schema = present_schema(stored.schema);
  }
  const auto config = std::find_if(stored.attributes.begin(), stored.attributes.end(),
                                   [](const auto& one) { return one.first == "config"; });
  if (config == stored.attributes.end()) return stored;
  const std::string present = stored_configuration(config->second);
  if (present == config->second) return stored;
  config->second = present;
  const Json json = parse_json(present, "config");
  const auto axes = json.find("axes");
  if (axes == json.end() || !axes->is_array()) return stored;
  for (std::size_t i = 0; i < std::min(axes->size(), stored.result.axes.size()); ++i)
    rename_axis((*axes)[i], stored.result.axes[i]);
  return stored;
}

}  // namespace

namespace {

// Throws InputError for a part of a sweep that has more runs than an array in memory should have.
StoredSweep whole(StoredSweep stored, const std::string& file) {
  if (stored.result.part && stored.result.run_count() > kMaxRunsInMemory)
    throw InputError(file, "holds " + std::to_string(stored.result.held_count()) + " of the " +
                               std::to_string(stored.result.run_count()) +
                               " runs of its sweep: expected a whole sweep, or one of at most " +
                               std::to_string(kMaxRunsInMemory) + " runs");
  stored.result = whole_of(std::move(stored.result));
  return with_present_names(std::move(stored));
}

}  // namespace

StoredSweep read_stored_sweep(const Hdf5Reader& file) {
  return whole(read_sweep(file), file.file());
}

StoredSweep read_stored_sweep(const std::filesystem::path& file) {
  return whole(read_sweep(file), file.string());
}

StoredSweep read_stored_outline(const Hdf5Reader& file) {
  return with_present_names(read_sweep_outline(file));
}

StoredSweep read_stored_part(const std::filesystem::path& file) {
  return with_present_names(read_sweep(file));
}

std::string damage_text(const StoredSweep& stored) {
  if (stored.damaged_runs == 0) return "";
  const bool is_one = stored.damaged_runs == 1;
  return std::to_string(stored.damaged_runs) + (is_one ? " run has" : " runs have") +
         " a wrong checksum, because of a partial write or damage: " + (is_one ? "it is" : "they are") +
         " left out, and the command of the sweep makes " + (is_one ? "it" : "them") + " again";
}

StoredSweep read_runs_or_outline(const std::filesystem::path& file) {
  const Hdf5Reader reader(file);
  if (!is_tally(reader)) return read_stored_part(file);
  StoredTally tally = read_tally(reader);
  return {outline_of(tally.tally), std::move(tally.attributes), false, tally.schema};
}

}  // namespace remote_touch
