#include "runners/interfaces/cli/progress.h"

#include <unistd.h>
#include "core/parameters/parameter.h"

#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

namespace remote_touch {

namespace {

// left_s: the time left, relative to the time since the program began; missing if nothing was done since.
template <class Number>
nlohmann::ordered_json counted_json(const std::string& what, Number done, Number total, Number earlier) {
  nlohmann::ordered_json json = {{"what", what}, {"done", done}, {"total", total}, {"elapsed_s", 0.0}};
  if (done > earlier)
    json["left_s"] = static_cast<double>(total - done) / static_cast<double>(done - earlier);
  return json;
}

}  // namespace

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
