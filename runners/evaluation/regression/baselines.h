// Baselines: their list, a stored result with the commands that make it again, the spread of its numbers over
// builds, and the commands that check and store a baseline.
#pragma once

#include <atomic>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "analysis/storage/hdf5_reader.h"
#include "analysis/trace/columns.h"
#include "runners/evaluation/regression/result_comparison.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep.h"

namespace remote_touch {

// The list of stored baselines: what made each, why it was stored, and how far a number may be from it.

// The reason why numbers were stored, which of them moved from those stored before, and by how much.
struct Revision {
  std::string reason;
  std::string moved;  // "" if nothing had been stored before, or if it was not recorded
};

// A result with which later programs are compared, NAME.h5 beside the manifest.
struct Baseline {
  std::string name;
  std::string command;  // "run" or "sweep"
  std::string subject;  // experiment or sweep: a name of the list, or a JSON file in the same folder
  std::vector<std::string> overrides = {};  // --set
  std::string sha256 = {};                  // hash of NAME.h5
  Revision revision = {};                   // revision of the stored numbers
  std::vector<Revision> history = {};       // all revisions before it, oldest first
  std::vector<std::string> builds = {};  // compilers, levels and threads over which the spread was measured
  // The spread, by column or measure; columns and measures without an entry are exact.
  Tolerances tolerances = {};
};

struct Manifest {
  // Every stored experiment, scenario, fixture rule, trajectory and renderer must have a baseline.
  bool complete = false;
  std::vector<Baseline> baselines = {};

  const Baseline* find(const std::string& name) const;
};

// FOLDER/manifest.json. Throws InputError when it cannot be read or is not as expected.
Manifest read_manifest(const std::filesystem::path& folder);
std::filesystem::path manifest_file(const std::filesystem::path& folder);
std::string text_of(const Manifest& manifest);  // the JSON that read_manifest() reads

std::filesystem::path file_of(const std::filesystem::path& folder, const Baseline& baseline);
// Returns the baseline's subject as the commands expect it: its name, or the path of its JSON file.
std::string subject_of(const std::filesystem::path& folder, const Baseline& baseline);

// A stored result, and the commands that make it again with this program.

struct Remaking {
  // Commands for a shell, in this order. Empty if no command of this program makes the result.
  std::vector<std::string> commands;
  // Why there are no commands, or why they are not those that made the result. Empty if they are.
  std::string reason = {};
};

class StoredResult {
 public:
  // Throws InputError for a file that is not a trace, a sweep, a figure or hashes of this program.
  explicit StoredResult(const std::string& file) : StoredResult(Hdf5Reader(file)) {}
  explicit StoredResult(const Hdf5Reader& result);

  const std::string& file() const { return file_; }
  const std::string& kind() const { return kind_; }  // see kind_of()
  const TextAttributes& attributes() const { return attributes_; }
  std::string of(const char* name) const { return attribute(attributes_, name); }
  const std::optional<Recipe>& recipe() const { return recipe_; }

  // The stored configuration with the present names, as JSON.
  std::string config() const;
  // Return the experiment of a trace or of hashes, and the sweep of a sweep, from the stored configuration.
  // Both throw InputError if this program cannot read it.
  Experiment experiment() const;
  Sweep sweep() const;

  // The commands of the recipe, if they still make the stored configuration. Otherwise the commands that make
  // the result from its configuration alone.
  Remaking remaking() const;

 private:
  bool is_known() const;
  bool command_makes_it() const;
  std::vector<std::string> recipe_commands() const;
  Remaking figure_remaking() const;
  Remaking detour() const;
  void add_shard(std::vector<std::string>& words) const;

  std::string file_, kind_;
  TextAttributes attributes_;
  std::optional<Recipe> recipe_;
};

// The spread of a baseline: one experiment or sweep is run with every build, on every instruction set and
// number of threads, and how far its numbers differ is measured.

// A new folder in TMPDIR, for runs whose results are read and then deleted. The destructor removes it with
// all its files; it must not contain folders. A program that is killed, or runs out of memory inside a
// library, leaves its folder; the next program removes it. A lock marks the folders that are in use, and a
// process loses its lock when it ends. Throws InputError if no folder can be made.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  std::filesystem::path path() const { return path_; }

 private:
  std::string path_;
  int descriptor_ = -1;
};

std::string this_program();  // the path of the running program

// Runs this program, or another build of it, to its end as a user would, without output. environment:
// variables set in addition; errors: a file for its stderr. Throws InputError, naming the program, with the
// last line of its errors, if it cannot be started, or its exit code is not 0 or not known. When stop is set,
// ends it and throws Interrupted.
void run_program(const std::string& program, const std::vector<std::string>& arguments,
                 const std::map<std::string, std::string>& environment, const std::filesystem::path& errors,
                 const std::atomic<bool>* stop);

// The columns of a result that are judged: those of a trace except the running hash, or the measures of a
// sweep.
std::vector<Column> judged_columns(const std::filesystem::path& file, const std::string& command);

struct MeasuredSpread {
  std::filesystem::path reference;  // made by the first program at this machine's highest level
  std::set<std::string> compilers = {};
  std::vector<std::string> over = {};  // compilers, levels and threads
  Tolerances spread = {};              // largest deviation from the reference, where it is not 0
};

// Runs the baseline's experiment with every program for all levels of this machine and 1, 2 and 8 threads,
// into the scratch folder. Throws InputError if a program fails or is of another source or configuration than
// the first. Throws InputError also if a state, a hash or the finiteness of a number differs, because these
// have no tolerance. Throws Interrupted when stop is set.
MeasuredSpread measure_spread(const std::filesystem::path& folder, const Baseline& baseline,
                              const std::vector<std::string>& programs, const std::filesystem::path& scratch,
                              const std::atomic<bool>* stop);

// Returns the new values, but with the old bits in every row that is within the tolerance. pre: old and new
// columns of the same result.
std::vector<Column> keep_old_bits(const std::vector<Column>& old, std::vector<Column> now,
                                  const Tolerances& tolerances);

// Makes a baseline's result again with the present program, and compares.

struct BaselineCheck {
  enum class State {
    same,
    changed,         // numbers outside the spread, or another experiment
    missing,         // a required baseline; fails a check as a change does
    not_comparable,  // the stored file is damaged, or what it runs cannot be run any more
    not_run          // a recording that it needs is not on this machine
  };
  std::string name;
  State state = State::same;
  std::string text = {};                            // one line
  std::optional<ResultComparison> comparison = {};  // if one was made
};

// Adds the notes on the runs to `notes`, unless it is null. Never throws InputError: a problem of one
// baseline must not hide the others. Throws Interrupted.
BaselineCheck check_baseline(const std::filesystem::path& folder, const Baseline& baseline,
                             const Kernels& kernels, const std::atomic<bool>* stop,
                             NoteCounts* notes = nullptr);

// Returns an entry `missing` for each experiment, scenario, fixture rule, trajectory and renderer that no
// baseline runs, except rules that read a file of the user, and parts named live-session. Returns none if the
// manifest need not be complete.
std::vector<BaselineCheck> missing_baselines(const std::filesystem::path& folder, const Manifest& manifest);

// Stores a baseline: its spread measured over builds, with a reason.

struct Blessing {
  std::filesystem::path folder;
  std::string name;
  std::string reason;
  std::string run, sweep;              // experiment or sweep of a new baseline; empty: as in the manifest
  std::vector<std::string> overrides;  // --set, only with run or sweep
  std::vector<std::string> also;       // builds of the same source by other compilers
  bool one_compiler = false;           // allows `also` to be empty: the spread is then of this compiler alone
  const std::atomic<bool>* stop = nullptr;
};

// Stores NAME.h5 and its entry in the manifest, which is created if missing. Numbers within the old spread of
// the old ones keep their old bits, and nothing is written if all do. Returns what was done, as text. Throws
// InputError without a reason, without a build of another compiler unless one_compiler is set, and as
// measure_spread() does. Throws Interrupted when stop is set. The stored files are unchanged in all these
// cases.
std::string bless(const Blessing& blessing);

}  // namespace remote_touch
