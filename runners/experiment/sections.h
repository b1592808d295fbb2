// The sections of an experiment as one table: reading, writing, validation, help and the tests follow from
// it. A new section is a member of ExperimentConfiguration and a line in sections.cpp.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "runners/experiment/configuration.h"

namespace remote_touch {

// Settings that a section may have: those of a scenario, say, by its name; without a name where there is only
// one kind of them.
struct SectionEntry {
  std::string name;
  std::string summary;
  std::function<std::unique_ptr<Configurable>()> make;  // with default values
};

struct ExperimentSection {
  const char* key;      // as in a file; of the one where is_top_level, only a name for it
  const char* summary;  // goes on after "... of an experiment: "
  // In a list of all that experiments can name; null where the section's entries have no names.
  const char* heading = nullptr;
  bool is_top_level = false;  // its parameters stand beside the other sections
  std::vector<SectionEntry> (*entries)() = nullptr;
  // From the whole configuration. Throws InputError for what cannot be used, and for a section that is
  // missing where it may not be left out.
  void (*read)(const ExperimentSection& section, const nlohmann::ordered_json& whole,
               ExperimentConfiguration& configuration) = nullptr;
  // Into the whole configuration, complete; nothing where the section is left out.
  void (*write)(const ExperimentSection& section, const ExperimentConfiguration& configuration,
                nlohmann::ordered_json& whole) = nullptr;
  // Adds the files that its settings name.
  void (*add_inputs)(const ExperimentConfiguration& configuration,
                     std::vector<RecordingPart>& inputs) = nullptr;
  // What holds between this section and others, when all are read: throws InputError, or adds what was left
  // out; null: nothing.
  void (*complete)(ExperimentConfiguration& configuration) = nullptr;
};

// In the order in which they are read and written.
std::span<const ExperimentSection> experiment_sections();

// Throws InputError for anything that cannot be run.
ExperimentConfiguration read_configuration(const nlohmann::ordered_json& json);
// Complete: every parameter of every section that is there.
nlohmann::ordered_json write_configuration(const ExperimentConfiguration& configuration);

}  // namespace remote_touch
