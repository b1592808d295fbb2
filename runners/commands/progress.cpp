#include "runners/commands/progress.h"

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
  if (shown_ && terminal_) std::fputs("\r\033[K", stderr);
}

void Progress::update(double share) {
  if (quiet_) return;
  const auto now = std::chrono::steady_clock::now();
  const auto seconds = [](auto from, auto to) { return std::chrono::duration<double>(to - from).count(); };
  if (seconds(last_, now) < (terminal_ ? 0.2 : 10.0)) return;
  last_ = now;
  shown_ = true;
  const double elapsed = seconds(start_, now);
  const double left = share > 0 ? elapsed / share - elapsed : 0;
  std::fprintf(stderr, "%s%s: %3.0f %%, %.1f %%/s, %.0f s left%s", terminal_ ? "\r\033[K" : "", what_.c_str(),
               100 * share, elapsed > 0 ? 100 * share / elapsed : 0, left, terminal_ ? "" : "\n");
  std::fflush(stderr);
}

}  // namespace remote_touch
