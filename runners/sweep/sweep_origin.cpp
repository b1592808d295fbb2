#include "runners/sweep/sweep_origin.h"

#include <algorithm>

#include "analysis/storage/hdf5_file.h"
#include "core/parameters/input_error.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/experiment/settings/changed_settings.h"

namespace remote_touch {

namespace {

std::string first_difference(const TextAttributes& theirs, const TextAttributes& ours) {
  const auto all = configuration_differences(attribute(theirs, "config"), attribute(ours, "config"));
  return all.empty() ? "its title" : all.front();
}

// Throws InputError for a sweep of an earlier schema. Its settings have other names, so that it would look
// like another sweep, and another program made it.
void require_present_schema(const std::filesystem::path& file, const std::string& schema) {
  if (is_earlier_schema(schema))
    throw InputError(file.string(), "was written with the earlier schema " + schema +
                                        ": expected a new file, in which the sweep starts again");
}

constexpr const char* kBuild[] = {"version", "git_commit", "git_dirty",      "source_digest", "compiler",
                                  "flags",   "program",    "program_sha256", "plugins"};

// Throws InputError for a file of another sweep, shard or build.
void require_same(const std::filesystem::path& file, const TextAttributes& theirs,
                  const TextAttributes& ours) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(file.string(),
                     what + ": expected a file of the same sweep, shard and build, or a new file");
  };
  if (attribute(theirs, "config") != attribute(ours, "config"))
    refuse("is of another configuration, first in " + first_difference(theirs, ours));
  const auto compare = [&](const std::string& name) {
    if (attribute(theirs, name) != attribute(ours, name))
      refuse("has " + name + " \"" + attribute(theirs, name) + "\", not \"" + attribute(ours, name) + "\"");
  };
  compare("shard");
  for (const char* name : kBuild) compare(name);
}

}  // namespace

TextAttributes build_of(const TextAttributes& attributes) {
  TextAttributes build;
  for (const char* name : kBuild) build.emplace_back(name, attribute(attributes, name));
  return build;
}

void require_same_sweep(const std::filesystem::path& file, const std::string& schema,
                        const TextAttributes& theirs, const TextAttributes& ours) {
  require_present_schema(file, schema);
  require_same(file, theirs, ours);
}

void require_same_origin(const MergedFile& part, const MergedFile& first) {
  const TextAttributes &ours = part.attributes, &theirs = first.attributes;
  for (const auto* attributes : {&ours, &theirs})  // either may have one that the other has not
    for (const auto& [name, value] : *attributes)
      // The path of the same file may be written differently.
      if (name != "input_digests" && name != "command" && name != kRecipe &&
          attribute(ours, name) != attribute(theirs, name))
        throw InputError(part.file,
                         "has another " + name + " than " + first.file +
                             (name == "config" ? ", first in " + first_difference(ours, theirs) : "") +
                             ": expected shards of one sweep, made by one build");
  for (const auto& input :
       changed_inputs(attribute(theirs, "input_digests"), attribute(ours, "input_digests")))
    throw InputError(part.file, "has runs on another recording " + input.path + " (" + input.now + "; " +
                                    first.file + ": " + input.before + "): expected shards of one sweep");
}

}  // namespace remote_touch
