#include "runners/interfaces/cli/outputs.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/digest.h"
#include "analysis/sweeps/sweep_file.h"
#include "analysis/sweeps/sweep_tally.h"
#include "core/parameters/parameter.h"
#include "runners/interfaces/cli/program.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep_answer.h"

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

namespace {

constexpr std::size_t kMaxFailures = 20;  // number that is printed

}  // namespace

std::string extent_text(const SweepGrid& grid) {
  std::string text;
  for (const Column& axis : grid.axes) text += (text.empty() ? "" : " x ") + std::to_string(axis.length());
  return text;
}

// Counts that were there come from lower runs.
void SweepSummary::add_notes(const std::vector<NoteCount>& counts) {
  for (const NoteCount& count : counts) {
    const auto same = std::find_if(notes_.begin(), notes_.end(),
                                   [&](const NoteCount& each) { return each.kind == count.kind; });
    if (same == notes_.end())
      notes_.push_back(count);
    else
      same->runs += count.runs;
  }
}

void SweepSummary::add(const SweepResult& block) {
  const std::vector<std::size_t> done = block.runs_in(RunState::done);
  const std::vector<std::size_t> failed = block.runs_in(RunState::failed);
  held_ += block.held_count(), done_ += done.size(), failed_ += failed.size();
  elsewhere_ += block.runs_in(RunState::elsewhere).size();
  for (const std::int32_t round : block.round) rounds_ = std::max(rounds_, round + 1);
  for (std::size_t i = 0; i < ranges_.size(); ++i) {
    const auto& values = std::get<std::vector<double>>(block.measures[i].values);
    Range& range = ranges_[i];
    for (const std::size_t place : done) {
      const double value = values[place];
      if (!std::isfinite(value)) continue;
      range.low = std::min(range.low, value), range.high = std::max(range.high, value), range.sum += value;
      ++range.count;
    }
  }
  for (std::size_t i = 0; i < failed.size() && failures_.size() < kMaxFailures; ++i) {
    const std::size_t run = block.run_at(failed[i]);
    failures_.push_back("--cell " + cell_text(block, block.cell_of(run)) + " --replicate " +
                        std::to_string(block.replicate_of(run)) + ": " + block.error[failed[i]]);
  }
  add_notes(note_counts(block));
}

// "mean 0.25  0 .. 1 1, of 4 of 5 runs". Runs whose value is not finite are left out, because an unknown
// outcome is neither 0 nor 1. The text then states the number of runs in the mean.
std::string SweepSummary::text_of(const Range& range, const std::string& units) const {
  if (range.count == 0) return "no value in any run";
  const std::string text =
      formatted("mean %-10.6g %.6g .. %.6g %s", range.sum / static_cast<double>(range.count), range.low,
                range.high, units.c_str());
  if (range.count == done_) return text;
  return text + formatted(", of %zu of %zu runs", range.count, done_);
}

int SweepSummary::print(const std::string& file, const std::string& digest) const {
  std::printf("%s: %s cells, %zu runs done, %zu failed", printable(file).c_str(), extent_text(grid_).c_str(),
              done_, failed_);
  if (rounds_ > 0) std::printf(" in %d rounds", rounds_);
  const std::size_t elsewhere = elsewhere_ + (rounds_ == 0 ? grid_.run_count() - held_ : 0);
  if (elsewhere > 0) std::printf(", %zu in other shards", elsewhere);
  std::printf(", digest %s\n", digest.c_str());
  for (std::size_t i = 0; done_ > 0 && i < ranges_.size(); ++i) {
    const Column& measure = grid_.measures[i];
    std::printf("  %-20s %s\n", measure.name.c_str(), text_of(ranges_[i], measure.units).c_str());
  }
  for (const std::string& line : note_lines(grid_, notes_, done_)) std::printf("  note: %s\n", line.c_str());
  for (const std::string& failure : failures_) std::printf("  failed: %s\n", failure.c_str());
  if (failed_ > failures_.size())
    std::printf("  and %zu more, in the dataset /sweep/error\n", failed_ - failures_.size());
  return failed_ == 0 ? kDone : kCheckFailed;
}

std::string note_on_equal_runs(const SweepGrid& grid, const std::string& config) {
  constexpr std::size_t kMostCells = 1'000'000;
  if (grid.replicates == 1 || grid.cell_count() > kMostCells) return {};
  const CellStreams streams = streams_of(grid, config);
  std::size_t fixed = 0, first = 0;
  for (std::size_t cell = grid.cell_count(); cell-- > 0;)
    if (streams.doubt.empty() && streams.is_fixed(cell)) ++fixed, first = cell;
  if (fixed == 0) return {};
  return formatted(
      "  note: %zu of %zu cells draw no random numbers: their %d replicates are equal, and analyse "
      "counts them as one run (the first: --cell %s)",
      fixed, grid.cell_count(), grid.replicates, cell_text(grid, first).c_str());
}

int print_summary(const std::string& file, const SweepResult& result) {
  SweepSummary summary(grid_of(result));
  summary.add(result);
  return summary.print(file, digest(result));
}

std::string measure_text(const MeasureTally& all, const std::string& units) {
  if (all.values == 0) return "no value in any run";
  const std::string text = formatted("mean %-10.6g %.6g .. %.6g %s, median %.3g", all.mean(), all.least,
                                     all.greatest, units.c_str(), all.quantile(0.5));
  if (all.unknown + all.infinite == 0) return text;
  return text + ", of " + std::to_string(all.values) + " of " +
         std::to_string(all.values + all.unknown + all.infinite) + " runs";
}

namespace {

void print_failures(const SweepTally& tally) {
  std::size_t cells = 0;
  for (const CellTally& cell : tally.tallies) {
    if (cell.failed == 0 || ++cells > kMaxFailures) continue;
    std::printf("  failed: %lld runs of one cell; the first is %s: %s\n", static_cast<long long>(cell.failed),
                option_of_run(tally, static_cast<std::size_t>(cell.first_failed)).c_str(),
                cell.first_error.c_str());
  }
  if (cells > kMaxFailures) std::printf("  and %zu more cells, in /tally/errors\n", cells - kMaxFailures);
}

}  // namespace

int print_summary(const std::string& file, const SweepTally& tally) {
  const CellTally all = tally.over_all_cells();
  std::printf("%s: %s cells, %lld runs done, %lld failed", printable(file).c_str(),
              extent_text(tally).c_str(), static_cast<long long>(all.done),
              static_cast<long long>(all.failed));
  if (const std::uint64_t others = tally.run_count() - tally.held.count(); others > 0)
    std::printf(", %llu not made here", static_cast<unsigned long long>(others));
  std::printf(", digest %s\n", digest(tally).c_str());
  for (std::size_t i = 0; i < all.measures.size(); ++i)
    std::printf("  %-20s %s\n", tally.measures[i].name.c_str(),
                measure_text(all.measures[i], tally.measures[i].units).c_str());
  for (const std::string& line : note_lines(tally)) std::printf("  note: %s\n", line.c_str());
  print_failures(tally);
  return all.failed == 0 ? kDone : kCheckFailed;
}

namespace {

constexpr std::size_t kUsualWidth = 80, kLeastWidth = 40;

bool begins_character(char c) {
  return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
}

std::size_t characters(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, begins_character));
}

// Returns where later lines begin: below the last text that two or more spaces separate from the text before
// it.
std::size_t indent_of(std::string_view line, std::size_t width) {
  const std::size_t first = std::min(line.find_first_not_of(' '), line.size());
  std::size_t indent = first + 2;
  for (std::size_t at = line.find("  ", first); at != std::string_view::npos; at = line.find("  ", at)) {
    at = line.find_first_not_of(' ', at);
    if (at == std::string_view::npos || characters(line.substr(0, at)) > width / 2) break;
    indent = characters(line.substr(0, at));
  }
  return std::min(indent, width / 2);
}

// Returns the number of bytes of the first line: up to the last space at or before the width, or up to the
// first space behind it. Spaces before the first word do not count.
std::size_t first_line(std::string_view text, std::size_t width) {
  const std::size_t begin = std::min(text.find_first_not_of(' '), text.size());
  std::size_t end = std::string_view::npos, count = characters(text.substr(0, begin));
  for (std::size_t i = begin; i < text.size(); ++i) {
    if (text[i] == ' ') {
      if (count > width) return end == std::string_view::npos ? i : end;
      end = i;
    }
    count += begins_character(text[i]) ? 1 : 0;
  }
  return count > width && end != std::string_view::npos ? end : text.size();
}

std::size_t terminal_width() {
  struct winsize size {};
  const bool is_known = ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return is_known ? std::max<std::size_t>(size.ws_col, kLeastWidth) : kUsualWidth;
}

// Writes all bytes, or returns false with errno.
bool write_all(const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t now = ::write(STDOUT_FILENO, text.data() + done, text.size() - done);
    if (now < 0 && errno != EINTR) return false;
    done += now > 0 ? static_cast<std::size_t>(now) : 0;
  }
  return true;
}

// A function of fopencookie(): a buffer has whole lines, or the beginning of one that goes on later.
ssize_t write_wrapped(void*, const char* bytes, std::size_t count) {
  std::string_view left(bytes, count);
  std::string text;
  const std::size_t width = terminal_width();
  for (std::size_t end = left.find('\n'); end != std::string_view::npos; end = left.find('\n')) {
    text += wrapped(left.substr(0, end), width);
    left.remove_prefix(end + 1);
  }
  return write_all(text.append(left)) ? static_cast<ssize_t>(count) : 0;
}

}  // namespace

std::string wrapped(std::string_view line, std::size_t width) {
  const std::string indent(indent_of(line, width), ' ');
  std::string text;
  std::string rest(line);
  while (characters(rest) > width) {
    const std::size_t end = first_line(rest, width);
    if (end == rest.size()) break;
    text += rest.substr(0, end) + "\n";
    const std::size_t next = rest.find_first_not_of(' ', end);
    if (next == std::string::npos) return text;  // spaces at the end
    rest = indent + rest.substr(next);
  }
  return text + rest + "\n";
}

void wrap_standard_output() {
  if (::isatty(STDOUT_FILENO) == 0) return;
  cookie_io_functions_t functions{};
  functions.write = write_wrapped;
  if (std::FILE* const file = ::fopencookie(nullptr, "w", functions)) {
    std::setvbuf(file, nullptr, _IOLBF, BUFSIZ);
    stdout = file;
  }
}

}  // namespace remote_touch
