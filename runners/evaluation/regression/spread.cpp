#include "runners/evaluation/regression/spread.h"

#include <algorithm>
#include <map>

#include "analysis/comparison/compared_columns.h"
#include "analysis/sweeps/sweep_file.h"
#include "analysis/trace/hash64.h"
#include "core/kernels/isa.h"
#include "core/parameters/input_error.h"
#include "runners/evaluation/regression/program_run.h"

namespace remote_touch {

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
