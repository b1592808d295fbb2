#include "runners/interfaces/cli/outputs.h"

#include <filesystem>
#include <functional>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/digest.h"
#include "core/parameters/parameter.h"

namespace remote_touch {

namespace {

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

using IsOurs = std::function<bool(const std::filesystem::path& file)>;

void require(const CommandLine& line, const std::string& output, const std::vector<std::string>& inputs,
             const IsOurs& is_ours, const char* kind) {
  for (const auto* all : {&inputs, &line.plugins})
    for (const std::string& input : *all) require_different_file(output, input);
  require_output(output, {.is_ours = is_ours, .kind = kind, .force = line.force});
}

IsOurs begins_with(const std::string& opening) {
  return [opening](const std::filesystem::path& file) { return opening_of(file, opening.size()) == opening; };
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

void require_text(const CommandLine& line, const std::string& output, const std::vector<std::string>& inputs,
                  const std::string& text) {
  const auto is_same = [text](const std::filesystem::path& file) {
    std::error_code absent;
    return std::filesystem::file_size(file, absent) == text.size() && opening_of(file, text.size()) == text;
  };
  require(line, output, inputs, is_same, "the same configuration");
}

void require_export(const CommandLine& line, const std::string& output,
                    const std::vector<std::string>& inputs, const std::string& opening) {
  require(line, output, inputs, begins_with(opening), "an export of such a result");
}

void require_distinct(const std::vector<OutputOption>& outputs) {
  for (auto a = outputs.begin(); a != outputs.end(); ++a)
    for (auto b = a + 1; b != outputs.end(); ++b)
      if (!a->file.empty() && !b->file.empty() && is_one_file(a->file, b->file))
        throw InputError(std::string(b->option) + " " + b->file,
                         std::string("is also the file of ") + a->option + ": expected another file");
}

std::vector<std::string> with_parts(const std::string& subject, const std::vector<InputPart>& parts) {
  std::vector<std::string> files{subject};
  for (const InputPart& part : parts) files.push_back(part.path);
  return files;
}

}  // namespace remote_touch
