#include "runners/interfaces/cli/outputs.h"

#include <unistd.h>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

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

// left_s: the time left, relative to the time since the program began; missing if nothing was done since.
template <class Number>
nlohmann::ordered_json counted_json(const std::string& what, Number done, Number total, Number earlier) {
  nlohmann::ordered_json json = {{"what", what}, {"done", done}, {"total", total}, {"elapsed_s", 0.0}};
  if (done > earlier)
    json["left_s"] = static_cast<double>(total - done) / static_cast<double>(done - earlier);
  return json;
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

std::string progress_text(double fraction, double elapsed_s) {
  const std::string done = formatted("%3.0f %%", 100 * fraction);
  if (!(fraction > 0 && elapsed_s > 0)) return done;
  return done +
         formatted(", %.1f %%/s, %.0f s left", 100 * fraction / elapsed_s, elapsed_s / fraction - elapsed_s);
}

std::string progress_text(std::size_t done, std::size_t total, std::size_t earlier, const char* things,
                          double elapsed_s) {
  const std::string counted = formatted("%zu of %zu %s", done, total, things);
  if (!(done > earlier && elapsed_s > 0)) return counted;
  const double rate = static_cast<double>(done - earlier) / elapsed_s;
  return counted + formatted(", %.4g/s, %.0f s left", rate, static_cast<double>(total - done) / rate);
}

Progress::Progress(std::string what, bool quiet)
    : what_(std::move(what)),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()),
      last_(start_) {}

Progress::~Progress() {
  clear();
}

void Progress::clear() {
  if (shown_ && terminal_) std::fputs("\r\033[K", stderr);
  shown_ = false;
}

bool Progress::is_due() {
  if (quiet_) return false;
  const auto now = std::chrono::steady_clock::now();
  const double least_s = is_json_ ? 1.0 : terminal_ ? 0.2 : 10.0;
  if (std::chrono::duration<double>(now - last_).count() < least_s) return false;
  last_ = now;
  return true;
}

void Progress::show(const std::string& text) {
  shown_ = true;
  std::fprintf(stderr, "%s%s: %s%s", terminal_ ? "\r\033[K" : "", what_.c_str(), text.c_str(),
               terminal_ ? "" : "\n");
  std::fflush(stderr);
}

// json: an object with what is done.
void Progress::print_json(nlohmann::ordered_json json) const {
  json["elapsed_s"] = elapsed_s();
  if (json.contains("left_s")) json["left_s"] = json["left_s"].get<double>() * elapsed_s();
  std::fprintf(stderr, "%s\n",
               json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace).c_str());
}

void Progress::update(const std::string& text) {
  if (!is_due()) return;
  if (is_json_) return print_json({{"what", what_}, {"text", text}});
  show(text);
}

void Progress::update(double fraction) {
  if (!is_due()) return;
  if (is_json_) return print_json(counted_json(what_, fraction, 1.0, 0.0));
  show(progress_text(fraction, elapsed_s()));
}

void Progress::update(std::size_t done, std::size_t total, std::size_t earlier, const char* things) {
  if (!is_due()) return;
  if (is_json_) return print_json(counted_json(what_, done, total, earlier));
  show(progress_text(done, total, earlier, things, elapsed_s()));
}

}  // namespace remote_touch
