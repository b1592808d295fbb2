#include "runners/cli/progress.h"

#include <unistd.h>

#include <cstdio>
#include <utility>

namespace remote_touch {

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
  if (!is_due()) return;
  const double elapsed = std::chrono::duration<double>(last_ - start_).count();
  char text[100];
  std::snprintf(text, sizeof text, "%3.0f %%, %.1f %%/s, %.0f s left", 100 * fraction,
                elapsed > 0 ? 100 * fraction / elapsed : 0, fraction > 0 ? elapsed / fraction - elapsed : 0);
  show(text);
}

void Progress::update(std::size_t done, std::size_t total, std::size_t earlier, const char* things) {
  if (!is_due()) return;
  const double elapsed = std::chrono::duration<double>(last_ - start_).count();
  const double rate = static_cast<double>(done - earlier) / elapsed;
  char text[160];
  std::snprintf(text, sizeof text, "%zu of %zu %s, %.4g/s, %.0f s left", done, total, things, rate,
                rate > 0 ? static_cast<double>(total - done) / rate : 0);
  show(text);
}

}  // namespace remote_touch
