#include "runners/evaluation/regression/baselines.h"

#include <dirent.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <new>
#include <string_view>
#include <thread>

#include "analysis/storage/other_processes.h"
#include "analysis/storage/trace_comparison.h"
#include "analysis/sweeps/sweep_file.h"
#include "analysis/trace/columns.h"
#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/simulation/simulation.h"

namespace remote_touch {
namespace {

constexpr const char* kScratchName = "remote-touch-bless-XXXXXX";  // each X is replaced
constexpr std::string_view kScratchStem = "remote-touch-bless-";

std::filesystem::path place_of_scratch() {
  std::error_code failure;
  std::filesystem::path place = std::filesystem::temp_directory_path(failure);
  if (failure) throw InputError("TMPDIR", failure.message() + ": expected a writable folder");
  return place;
}

// Calls use(name) for each name in an open folder. Allocates no memory, unlike readdir() and
// std::filesystem::directory_iterator.
template <class Use>
void for_each_name(int folder, const Use& use) {
  const int list = ::openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (list < 0) return;
  alignas(dirent64) char names[4096];
  for (ssize_t size; (size = ::getdents64(list, names, sizeof names)) > 0;)
    for (ssize_t at = 0; at < size;) {
      const auto* const entry = reinterpret_cast<const dirent64*>(names + at);
      use(entry->d_name);
      at += entry->d_reclen;
    }
  ::close(list);
}

void remove_with_files(int parent, const char* name, int folder) {
  for_each_name(folder, [&](const char* file) { ::unlinkat(folder, file, 0); });
  ::unlinkat(parent, name, AT_REMOVEDIR);
}

int open_folder(int parent, const char* name) {
  return ::openat(parent, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
}

// Removes the folders of programs that could not remove them: folders that no program holds locked.
void remove_abandoned(const std::filesystem::path& place) {
  const int parent = ::open(place.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (parent < 0) return;
  for_each_name(parent, [&](const char* name) {
    if (!std::string_view(name).starts_with(kScratchStem)) return;
    const int folder = open_folder(parent, name);
    if (folder < 0) return;
    if (lock_error(folder, LOCK_EX | LOCK_NB) == 0) remove_with_files(parent, name, folder);
    ::close(folder);
  });
  ::close(parent);
}

[[noreturn]] void refuse_scratch(const std::string& folder, int error) {
  throw InputError(folder,
                   std::string("cannot be made (") + std::strerror(error) + "): expected a writable folder");
}

// Waits for the lock. Returns false if the place has no locks; then no other program can lock the folder
// either, so none removes it.
bool take_lock(const std::string& path, int folder) {
  const int error = lock_error(folder, LOCK_EX);
  if (error == 0 || has_no_locks(error)) return error == 0;
  ::rmdir(path.c_str());
  ::close(folder);
  throw InputError(path, std::string("cannot be locked (") + std::strerror(error) +
                             "): expected a TMPDIR whose locks work, or one without locks");
}

bool has_links(int folder) {
  struct stat about = {};
  return ::fstat(folder, &about) == 0 && about.st_nlink > 0;
}

}  // namespace

ScratchFolder::ScratchFolder() {
  const std::filesystem::path place = place_of_scratch();
  remove_abandoned(place);
  // Another program may classify the folder as abandoned and remove it before it is locked. Then another
  // folder is made.
  do {
    if (descriptor_ >= 0) ::close(descriptor_);
    path_ = place / kScratchName;
    if (!::mkdtemp(path_.data())) refuse_scratch(path_, errno);
    descriptor_ = open_folder(AT_FDCWD, path_.c_str());
    if (descriptor_ < 0) {
      const int error = errno;
      ::rmdir(path_.c_str());
      refuse_scratch(path_, error);
    }
  } while (take_lock(path_, descriptor_) && !has_links(descriptor_));
}

ScratchFolder::~ScratchFolder() {
  remove_with_files(AT_FDCWD, path_.c_str(), descriptor_);
  ::close(descriptor_);
}

namespace {

// File actions of a spawned program: its output is discarded, and its errors are written to a file.
class OutputTo {
 public:
  explicit OutputTo(const std::filesystem::path& errors) : errors_(errors) {
    const int error =
        ::posix_spawn_file_actions_init(&actions_) != 0
            ? ENOMEM
            : first_of(::posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, "/dev/null", O_WRONLY, 0),
                       ::posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, errors_.c_str(),
                                                          O_WRONLY | O_CREAT | O_TRUNC, 0666));
    if (error != 0) throw std::bad_alloc();
  }
  ~OutputTo() { ::posix_spawn_file_actions_destroy(&actions_); }
  OutputTo(const OutputTo&) = delete;
  OutputTo& operator=(const OutputTo&) = delete;
  const posix_spawn_file_actions_t* actions() const { return &actions_; }

 private:
  static int first_of(int a, int b) { return a != 0 ? a : b; }
  const std::string errors_;
  posix_spawn_file_actions_t actions_{};
};

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> all;
  for (std::string& text : texts) all.push_back(text.data());
  all.push_back(nullptr);
  return all;
}

// This process's environment, which its programs inherit, with some variables set in addition: "NAME=value".
std::vector<std::string> environment_with(const std::map<std::string, std::string>& more) {
  std::vector<std::string> all;
  for (char** one = environ; *one; ++one) {
    const std::string_view text = *one;
    if (!more.contains(std::string(text.substr(0, text.find('='))))) all.emplace_back(text);
  }
  for (const auto& [name, value] : more) all.push_back(name + "=" + value);
  return all;
}

// Spawns the program and does not fork: a child that runs out of memory between fork and exec would continue
// as a second copy of this program.
pid_t start(const std::string& program, std::vector<std::string> arguments,
            const std::map<std::string, std::string>& environment, const std::filesystem::path& errors) {
  arguments.insert(arguments.begin(), program);
  std::vector<std::string> variables = environment_with(environment);
  const OutputTo output(errors);
  pid_t child = 0;
  const int error = ::posix_spawn(&child, program.c_str(), output.actions(), nullptr,
                                  pointers(arguments).data(), pointers(variables).data());
  if (error != 0)
    throw InputError(program, std::string("cannot be started (") + std::strerror(error) +
                                  "): expected a build of remote-touch");
  return child;
}

// Waits for the child and returns its status. When stop is set, sends SIGTERM to the child, waits for its end
// and throws Interrupted. Throws InputError if the status is not known, as when this process ignores SIGCHLD.
int end_of(pid_t child, const std::string& program, const std::atomic<bool>* stop) {
  int status = 0;
  bool signalled = false;
  pid_t ended = 0;
  while ((ended = ::waitpid(child, &status, WNOHANG)) == 0) {
    if (stop && *stop && !signalled) ::kill(child, SIGTERM), signalled = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  const int error = errno;
  if (stop && *stop) throw Interrupted{};
  if (ended < 0)
    throw InputError(program, std::string("has an unknown end (") + std::strerror(error) +
                                  "): expected a caller that does not ignore SIGCHLD");
  return status;
}

// Returns the last line that the program wrote to standard error, in parentheses; empty if it wrote none.
std::string last_line(const std::filesystem::path& errors) {
  std::ifstream in(errors);
  std::string last;
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) last = " (" + line + ")";
  return last;
}

}  // namespace

std::string this_program() {
  return std::filesystem::read_symlink("/proc/self/exe").string();
}

void run_program(const std::string& program, const std::vector<std::string>& arguments,
                 const std::map<std::string, std::string>& environment, const std::filesystem::path& errors,
                 const std::atomic<bool>* stop) {
  const pid_t child = start(program, arguments, environment, errors);
  const int status = end_of(child, program, stop);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  throw InputError(program, "failed with " +
                                (WIFEXITED(status) ? "exit code " + std::to_string(WEXITSTATUS(status))
                                                   : "signal " + std::to_string(WTERMSIG(status))) +
                                last_line(errors) + ": expected a build that runs what is to be stored");
}

namespace {

constexpr int kThreads[] = {1, 2, 8};

void make(const std::filesystem::path& folder, const Baseline& baseline, const std::string& program,
          const std::string& level, int threads, const std::filesystem::path& output,
          const std::atomic<bool>* stop) {
  std::vector<std::string> words = {baseline.command, subject_of(folder, baseline)};
  for (const std::string& assignment : baseline.overrides) words.insert(words.end(), {"--set", assignment});
  words.insert(words.end(), {"--quiet", "-o", output.string()});
  if (baseline.command == "sweep") words.insert(words.end(), {"--threads", std::to_string(threads)});
  run_program(program, words, {{"REMOTE_TOUCH_ISA", level}, {"OMP_NUM_THREADS", std::to_string(threads)}},
              output.parent_path() / "errors", stop);
}

struct Made {
  TextAttributes attributes;
  std::vector<Column> columns;
};
Made read_made(const std::string& program, const std::string& command, const std::filesystem::path& output) {
  try {
    return {Hdf5Reader(output).attributes(), judged_columns(output, command)};
  } catch (const InputError& error) {
    throw InputError(program,
                     "wrote no result (" + std::string(error.what()) + "): expected a build of remote-touch");
  }
}

void require_same_source(const std::string& program, const TextAttributes& reference,
                         const TextAttributes& other) {
  for (const char* name : {"version", "git_commit", "source_digest", "config"})
    if (attribute(reference, name) != attribute(other, name))
      throw InputError(program, std::string("is of another ") + name + ", " + attribute(other, name) +
                                    ": expected a build of the same source as this program");
}

// Adds the deviations of one variant to the spread.
void add(const std::string& variant, const std::vector<Column>& reference, const std::vector<Column>& other,
         Tolerances& spread) {
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const ColumnComparison found = compare_columns(reference[i], other.at(i), {});
    if (!found.problem.empty() || found.not_numbers > 0 || (found.outside > 0 && found.max == 0))
      throw InputError(reference[i].name, "differs with " + variant + " in row " +
                                              std::to_string(found.first_outside.value_or(0)) +
                                              ", in a value that has no tolerance" +
                                              (found.problem.empty() ? "" : ": " + found.problem));
    if (found.max > 0) spread[found.name].absolute = std::max(spread[found.name].absolute, found.max);
  }
}

void note(std::vector<std::string>& list, const std::string& text) {
  if (std::find(list.begin(), list.end(), text) == list.end()) list.push_back(text);
}

std::vector<std::string> levels_of_this_machine() {
  std::vector<std::string> levels;  // the best first: it makes the reference
  for (const Kernels* kernels : supported_kernels()) levels.insert(levels.begin(), kernels->isa);
  return levels;
}

// False for names and fingerprints, which have no tolerance in compare_columns().
bool has_tolerance(const Column& column) {
  return std::holds_alternative<std::vector<double>>(column.values) ||
         (std::holds_alternative<std::vector<std::int32_t>>(column.values) && column.value_names.empty());
}

// Copies the old values to `now` in the rows whose deviation is at most `allowed`, which a NaN is not.
template <class Values>
void keep_rows(const Values& old, const std::vector<double>& deviation, double allowed, std::size_t width,
               Values& now) {
  for (std::size_t row = 0; row < deviation.size(); ++row)
    if (deviation[row] <= allowed)
      std::copy_n(old.begin() + static_cast<std::ptrdiff_t>(row * width), width,
                  now.begin() + static_cast<std::ptrdiff_t>(row * width));
}

}  // namespace

std::vector<Column> judged_columns(const std::filesystem::path& file, const std::string& command) {
  if (command == "sweep") return read_sweep(file).result.measures;
  const StoredTrace trace(file);
  std::vector<Column> columns;
  for (const std::string& name : trace.column_names())
    if (name != kRunningHash) columns.push_back(trace.column(name));
  return columns;
}

MeasuredSpread measure_spread(const std::filesystem::path& folder, const Baseline& baseline,
                              const std::vector<std::string>& programs, const std::filesystem::path& scratch,
                              const std::atomic<bool>* stop) {
  MeasuredSpread measured{scratch / "reference.h5"};
  std::vector<Column> reference;
  TextAttributes first;
  for (const std::string& program : programs)
    for (const std::string& level : levels_of_this_machine())
      for (const int threads : kThreads) {
        const auto output = reference.empty() ? measured.reference : scratch / "variant.h5";
        std::filesystem::remove(scratch / "variant.h5");
        make(folder, baseline, program, level, threads, output, stop);
        const Made made = read_made(program, baseline.command, output);
        const std::string compiler = attribute(made.attributes, "compiler");
        for (const std::string& what : {compiler, level, std::to_string(threads) + " threads"})
          note(measured.over, what);
        measured.compilers.insert(compiler);
        if (reference.empty()) {
          reference = made.columns, first = made.attributes;
          continue;
        }
        require_same_source(program, first, made.attributes);
        add(compiler + ", " + level + ", " + std::to_string(threads) + " threads", reference, made.columns,
            measured.spread);
      }
  return measured;
}

std::vector<Column> keep_old_bits(const std::vector<Column>& old, std::vector<Column> now,
                                  const Tolerances& tolerances) {
  for (Column& column : now) {
    const auto before =
        std::find_if(old.begin(), old.end(), [&](const Column& one) { return one.name == column.name; });
    if (before == old.end() || !compare_columns(*before, column, {}).problem.empty()) continue;
    const double allowed = has_tolerance(column) ? tolerance_of(tolerances, column.name).absolute : 0;
    const std::vector<double> deviation = deviations(*before, column);
    std::visit(
        [&](auto& values) {
          using Kind = std::decay_t<decltype(values)>;
          keep_rows(std::get<Kind>(before->values), deviation, allowed,
                    static_cast<std::size_t>(column.width), values);
        },
        column.values);
  }
  return now;
}

}  // namespace remote_touch
