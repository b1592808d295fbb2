// The provenance of a result: program, build and command, as text attributes.
#pragma once

#include <string>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "runners/experiment/provenance/recipe.h"

namespace remote_touch {

std::string version();   // "0.3.0"
std::string cpu_name();  // name that the system reports; empty if it reports none

// The program and the plug-ins that made a result, in addition to the sources of this project.
struct ProgramIdentity {
  struct Plugin {
    std::string file, sha256;
  };
  std::string name = "remote-touch";
  std::string sha256 = {};  // hash of the program's file if its catalog has entries of its own; else empty
  std::vector<Plugin> plugins = {};  // shared libraries with renderers
};
// Sets the identity for all results. Results have the attributes `program` and `program_sha256` if there is a
// SHA-256, and `plugins` (a line "FILE: sha256 HASH" for each) if there are any. Commands begin with
// program_words(). Must be called before the first result.
void identify_program(ProgramIdentity identity);
const ProgramIdentity& program_identity();
// "remote-touch", "--plugin", "mine.so"
std::vector<std::string> program_words();
std::string program_text();  // the same for a shell

// Returns "commit HASH", "commit HASH with local changes" or "commit unknown (built without git)", from the
// attributes git_commit and git_dirty that provenance() writes.
std::string commit_text(const TextAttributes& attributes);

// command: normalised by the caller (no output path, no thread count). config: resolved JSON. isa may be
// empty, for results that several machines made together; it is then left out. inputs: the text of
// input_hashes.h; empty if nothing was read, and then left out.
TextAttributes provenance(const std::string& config, const std::string& command, const std::string& isa,
                          const std::string& inputs = {});
// The same with the recipe as fields in addition to its command.
TextAttributes provenance(const std::string& config, const Recipe& recipe, const std::string& isa,
                          const std::string& inputs = {});

}  // namespace remote_touch
