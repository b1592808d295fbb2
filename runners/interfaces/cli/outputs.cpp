#include "runners/interfaces/cli/outputs.h"

#include <filesystem>
#include <functional>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/block_journal.h"
#include "analysis/storage/file_digest.h"
#include "analysis/storage/replacement_rule.h"
#include "core/parameters/input_error.h"

namespace remote_touch {

namespace {

// True for a regular file that is not empty. A device holds no data that could be lost.
bool holds_something(const std::string& file) {
  std::error_code absent;
  return std::filesystem::is_regular_file(file, absent) && std::filesystem::file_size(file, absent) > 0;
}

bool is_one_file(const std::string& a, const std::string& b) {
  namespace fs = std::filesystem;
  std::error_code absent;
  if (fs::exists(a, absent) && !fs::is_regular_file(a, absent)) return false;
  if (fs::equivalent(a, b, absent)) return true;
  const auto place = [&](const std::string& file) {
    return fs::weakly_canonical(fs::absolute(resolved(file), absent), absent);
  };
  return place(a) == place(b);
}

using IsOurs = std::function<bool(const std::string& file)>;

// The same check decides again when the result is finished, because the file may have been written meanwhile.
void require(const CommandLine& line, const std::string& output, const std::vector<std::string>& inputs,
             const IsOurs& is_ours, const char* kind) {
  for (const auto* all : {&inputs, &line.plugins})
    for (const std::string& input : *all) require_different_file(output, input);
  if (is_journal(output))
    throw InputError(output, "is an unfinished recording and is never overwritten: expected another file");
  const auto may_replace = [is_ours, force = line.force](const std::filesystem::path& file) {
    if (is_journal(file)) return false;
    return force || !holds_something(file) || is_ours(file);
  };
  if (!may_replace(output))
    throw InputError(output, std::string("exists already and is not ") + kind +
                                 " of this program: expected another file, or --force");
  require_writable(output);
  set_replacement_rule(output, may_replace);
}

IsOurs begins_with(const std::string& opening) {
  return [opening](const std::string& file) {
    return holds_something(file) && opening_of(file, opening.size()) == opening;  // a pipe would wait
  };
}

}  // namespace

FileLock lock_output(const CommandLine& line, const std::string& output,
                     const std::vector<std::string>& inputs) {
  require_result(line, output, inputs);
  return FileLock(output);
}

void require_result(const CommandLine& line, const std::string& output,
                    const std::vector<std::string>& inputs) {
  require(line, output, inputs, has_result_header, "a result");
}

void require_report(const CommandLine& line, const std::string& output,
                    const std::vector<std::string>& inputs, const std::string& opening) {
  require(line, output, inputs, begins_with(opening), "a report");
}

void require_export(const CommandLine& line, const std::string& output,
                    const std::vector<std::string>& inputs, const std::string& opening) {
  require(line, output, inputs, begins_with(opening), "an export of such a result");
}

void replace_only_results(const std::string& output) {
  set_replacement_rule(output, [](const std::filesystem::path& file) {
    return !holds_something(file) || has_result_header(file);
  });
}

void require_distinct(const std::vector<OutputOption>& outputs) {
  for (auto a = outputs.begin(); a != outputs.end(); ++a)
    for (auto b = a + 1; b != outputs.end(); ++b)
      if (!a->file.empty() && !b->file.empty() && is_one_file(a->file, b->file))
        throw InputError(std::string(b->option) + " " + b->file,
                         std::string("is also the file of ") + a->option + ": expected another file");
}

std::vector<std::string> with_parts(const std::string& subject, const std::vector<RecordingPart>& parts) {
  std::vector<std::string> files{subject};
  for (const RecordingPart& part : parts) files.push_back(part.path);
  return files;
}

}  // namespace remote_touch
