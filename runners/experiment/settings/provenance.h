// The provenance of a result, as attributes: program, build, command, recipe and the hashes of its inputs.
// The x86-64 level of the inner loops is one of them.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "scenarios/recordings/recording.h"

namespace remote_touch {

// Commands as text for a shell.

// Returns the words with spaces between them. A word is in single quotes if it needs them.
std::string shell_command(const std::vector<std::string>& words);

// The recipe of a result, as fields, with which a program can make it again.

struct Recipe {
  std::string action;   // run, sweep, replay, figure or compare
  std::string subject;  // subject of the action; the sweep of a replay, the baseline of a comparison
  std::vector<std::string> overrides = {};  // key=value
  std::vector<std::size_t> cell = {};       // cell of a replay: index on each axis
  int replicate = 0;                        // replicate of a replay
  int coarse = 1;                           // --coarse of a figure; 1: all values of each axis
  std::string candidate = {};               // candidate of a comparison
  std::vector<std::string> tolerances = {};
};

// Returns the words of each command, without output, threads and shard. A replay has two commands: the
// command of its sweep and its own.
std::vector<std::vector<std::string>> commands(const Recipe& recipe);
// The same as text for a shell, "; " between the commands.
std::string command_text(const Recipe& recipe);

// The attribute of the result that holds its recipe as JSON.
inline constexpr const char* kRecipe = "recipe";
std::string to_json(const Recipe& recipe);
// Returns nothing if the result has no recipe, or one that this program cannot read.
std::optional<Recipe> recipe_of(const TextAttributes& attributes);

// The provenance of a result: program, build and command, as text attributes.

std::string version();   // "0.3.0"
std::string cpu_name();  // name that the system reports; empty if it reports none

// Returns the kernels of that x86-64 level or, if it is empty, of the highest level of this processor. No
// result depends on the level: all give the same bits. Throws InputError if the machine does not have the
// level.
const Kernels& kernels_of_level(const std::string& level);

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
// input_hashes(); empty if nothing was read, and then left out.
TextAttributes provenance(const std::string& config, const std::string& command, const std::string& isa,
                          const std::string& inputs = {});
// The same with the recipe as fields in addition to its command.
TextAttributes provenance(const std::string& config, const Recipe& recipe, const std::string& isa,
                          const std::string& inputs = {});

// Names the program that made a result, if the catalog of that program may have entries that this program
// does not have.

// Returns "was made by press-lab, ...: expected that program", or a text with the plug-ins that the result
// names. Returns an empty text if this program made the result and has loaded all these plug-ins. Plug-ins
// are the same if their SHA-256 is.
std::string other_maker(const TextAttributes& result);

// Calls read(), which reads the configuration of a result, and returns its value. If read() throws InputError
// and other_maker() is not empty, throws an InputError that begins with that text, because the other program
// may have an entry that is unknown here.
template <class Read>
auto read_configuration(const TextAttributes& result, const std::string& file, Read&& read) {
  try {
    return read();
  } catch (const InputError& error) {
    const std::string maker = other_maker(result);
    if (maker.empty()) throw;
    throw InputError(file, maker + " (here: " + error.what() + ")");
  }
}

// Hashes of the recordings that a result was made from: the attribute `input_digests` of result files.

// The text has one line for each recording, sorted by path:
//
//   PATH: 71 file(s), 4929174 bytes, sha256 HASH
//
// PATH is scenario.path as the configuration gives it, without the folder below which it was found. The files
// are those of files_of(), from which the frames first_frame to last_frame are made. HASH is the SHA-256 over
// one line for each, "<its own SHA-256>  <its name from the recording's folder>\n", the lines sorted by their
// bytes. So anybody can compute it again, for a folder and for a single PCD file:
//
//   cd PATH && sha256sum camera.json depth/0000.png depth/0001.png ... | LC_ALL=C sort | sha256sum
//   cd "$(dirname PATH)" && sha256sum "$(basename PATH)" | sha256sum
//
// If runs read different parts of one recording, its line covers the files of all of them.
class InputHashes {
 public:
  // Reads each file once. Throws InputError as files_of() does, and for a file that cannot be read.
  void add(const std::vector<InputPart>& parts);
  std::string text() const;  // empty: nothing was added
  // Reads the files again and throws InputError if they differ from those that were added.
  void require_unchanged() const;

 private:
  void read(const InputPart& part);

  struct Known {
    std::string sha256;
    std::uintmax_t size = 0;
  };
  std::map<std::string, std::map<std::string, Known>> recordings_;  // keys: path, then name
  std::set<InputPart> parts_;
};

std::string input_hashes(const std::vector<InputPart>& parts);

// before: input_hashes(parts) from before the runs. Reads the files again and throws InputError if they
// differ, so that no result states the hash of a file that its runs did not read.
void require_unchanged(const std::vector<InputPart>& parts, const std::string& before);

// Returns a path or name on one line, as sha256sum writes it: a backslash, line feed or carriage return in it
// is written \\, \n, \r.
std::string in_one_line(const std::string& name);

// A recording whose line differs between two texts of input_hashes().
struct ChangedInput {
  std::string path;         // written as in_one_line() does
  std::string before, now;  // the rest of the line: "71 file(s), ..."; "absent" if there is none
};
std::vector<ChangedInput> changed_inputs(const std::string& before, const std::string& now);

// Entries for BibTeX: of the program, and of its results.

// Returns the text of printable() such that TeX prints it as it is: characters with a meaning in TeX or
// BibTeX are escaped, and "--" does not become a dash. Braces are always balanced.
std::string bibtex_text(const std::string& text);

// The entry "@phdthesis{ryden_2013, ...}" of the dissertation, the source of the method.
std::string dissertation_entry();

// The entry "@software{remote_touch_COMMIT, ...}" of the program that wrote these attributes of a result, or
// of this program if they come from provenance(). It has the SHA-256 of the sources if the commit alone does
// not identify them.
std::string program_entry(const TextAttributes& attributes);

struct CitedResult {
  std::string file;
  std::string kind;                        // "trace"
  std::string title = {};                  // one line; empty: the entry has the name of the file instead
  std::string digest = {};                 // "digest ...", or another text that identifies the content
  std::vector<std::string> commands = {};  // make it again; may be empty
  std::string remark = {};  // why there are no commands, or what to know about them; may be empty
};
// The entry "@misc{FILE, ...}" of a result with these attributes. It has no date, because a result stores
// none, and no author, because a result does not know who ran the program. Commands that printable() would
// shorten or change are replaced with the call of `repro` that prints them.
std::string result_entry(const CitedResult& result, const TextAttributes& attributes);

}  // namespace remote_touch
