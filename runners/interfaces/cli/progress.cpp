#include "runners/interfaces/cli/progress.h"

#include <unistd.h>

#include <cstdio>
#include <utility>

namespace remote_touch {

namespace {

template <class... Values>
std::string filled(const char* form, Values... values) {
  char text[160];
  std::snprintf(text, sizeof text, form, values...);
  return text;
}

}  // namespace

std::string progress_text(double fraction, double elapsed_s) {
  const std::string done = filled("%3.0f %%", 100 * fraction);
  if (!(fraction > 0 && elapsed_s > 0)) return done;
  return done +
         filled(", %.1f %%/s, %.0f s left", 100 * fraction / elapsed_s, elapsed_s / fraction - elapsed_s);
}

std::string progress_text(std::size_t done, std::size_t total, std::size_t earlier, const char* things,
                          double elapsed_s) {
  const std::string counted = filled("%zu of %zu %s", done, total, things);
  if (!(done > earlier && elapsed_s > 0)) return counted;
  const double rate = static_cast<double>(done - earlier) / elapsed_s;
  return counted + filled(", %.4g/s, %.0f s left", rate, static_cast<double>(total - done) / rate);
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
  if (std::chrono::duration<double>(now - last_).count() < (terminal_ ? 0.2 : 10.0)) return false;
  last_ = now;
  return true;
}

void Progress::show(const std::string& text) {
  shown_ = true;
  std::fprintf(stderr, "%s%s: %s%s", terminal_ ? "\r\033[K" : "", what_.c_str(), text.c_str(),
               terminal_ ? "" : "\n");
  std::fflush(stderr);
}

void Progress::update(const std::string& text) {
  if (is_due()) show(text);
}

void Progress::update(double fraction) {
  if (is_due()) show(progress_text(fraction, elapsed_s()));
}

void Progress::update(std::size_t done, std::size_t total, std::size_t earlier, const char* things) {
  if (is_due()) show(progress_text(done, total, earlier, things, elapsed_s()));
}

}  // namespace remote_touch
