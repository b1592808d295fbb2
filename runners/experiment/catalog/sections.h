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

// Settings that a section may have: for example those of a scenario, by its name; without a name if there is
// only one kind.
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
  // Writes the section, complete, into the whole configuration; nothing if it was left out.
  void (*write)(const ExperimentSection& section, const ExperimentConfiguration& configuration,
                nlohmann::ordered_json& whole) = nullptr;
  // Adds the files that its settings name.
  void (*add_inputs)(const ExperimentConfiguration& configuration,
                     std::vector<RecordingPart>& inputs) = nullptr;
  // Checks this section against the others when all are read: throws InputError, or adds what was left out;
  // null: no check.
  void (*complete)(ExperimentConfiguration& configuration) = nullptr;
};

// The sections, in the order in which they are read and written.
std::span<const ExperimentSection> experiment_sections();

// Throws InputError for anything that cannot be run.
ExperimentConfiguration read_configuration(const nlohmann::ordered_json& json);
// Complete: every parameter of every section that is present.
nlohmann::ordered_json write_configuration(const ExperimentConfiguration& configuration);
// The part of it that a key of its top level belongs to: that section alone, as a member of an object.
nlohmann::ordered_json write_section_of(const ExperimentConfiguration& configuration, const std::string& key);

}  // namespace remote_touch
