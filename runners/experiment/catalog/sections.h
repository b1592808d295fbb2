// The sections of an experiment as one table: reading, writing, validation, help and the tests follow from
// it. A new section is a member of ExperimentConfiguration and a line in sections.cpp.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "runners/experiment/catalog/configuration.h"

namespace remote_touch {

// One kind of settings that a section may have, for example those of the scenario with this name. The name is
// empty if the section has only one kind.
struct SectionEntry {
  std::string name;
  std::string summary;
  std::function<std::unique_ptr<Configurable>()> make;  // makes settings with default values
};

struct ExperimentSection {
  const char* key;      // key in a file; only a name if is_top_level
  const char* summary;  // continues "... of an experiment: "
  // Heading in a list of all that experiments can name; null if the section's entries have no names.
  const char* heading = nullptr;
  bool is_top_level = false;  // its parameters are at the level of the other sections
  std::vector<SectionEntry> (*entries)() = nullptr;
  // Reads the section from the whole configuration. Throws InputError for settings that cannot be used, and
  // for a missing section that is required.
  void (*read)(const ExperimentSection& section, const nlohmann::ordered_json& whole,
               ExperimentConfiguration& configuration) = nullptr;
  // Writes all parameters of the section into the whole configuration. An optional section that was left out
  // is not written; a list of catalog entries that was left out is written as an empty list.
  void (*write)(const ExperimentSection& section, const ExperimentConfiguration& configuration,
                nlohmann::ordered_json& whole) = nullptr;
  // Adds the files that its settings name. Null: they name none.
  void (*add_inputs)(const ExperimentConfiguration& configuration, std::vector<InputPart>& inputs) = nullptr;
  // Called after all sections are read. Checks this section against the others: throws InputError, or adds
  // settings that were left out. Null: no check.
  void (*complete)(ExperimentConfiguration& configuration) = nullptr;
};

// The sections, in the order in which they are read and written.
std::span<const ExperimentSection> experiment_sections();

// Throws InputError if `json` has another entry in a section than `former` had, and still has a parameter
// that only the former entry has: --set replaced the name alone.
void refuse_former_keys(const nlohmann::ordered_json& former, const nlohmann::ordered_json& json);
// Throws InputError for anything that cannot be run.
ExperimentConfiguration read_configuration(const nlohmann::ordered_json& json);
// Returns the complete configuration: every parameter of every section that is present.
nlohmann::ordered_json write_configuration(const ExperimentConfiguration& configuration);
// Returns the part of write_configuration() to which a key of its top level belongs: an object with that
// section as its only member. If the key is not a section, returns the parameters at the level of the
// sections.
nlohmann::ordered_json write_section_of(const ExperimentConfiguration& configuration, const std::string& key);

}  // namespace remote_touch
