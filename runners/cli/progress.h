// Progress on stderr, apart from results on stdout.
#pragma once

#include <chrono>
#include <string>

namespace remote_touch {

// A line that is overwritten on a terminal, and a line every ten seconds elsewhere. Not for use from several
// threads at once.
class Progress {
 public:
  Progress(std::string what, bool quiet);
  ~Progress();
  void update(double fraction);  // 0 to 1
  void update(const std::string& text);
  void clear();  // before something else is printed
  // Counted things, earlier ones of them done before this program began.
  void update(std::size_t done, std::size_t total, std::size_t earlier, const char* things);

 private:
  bool is_due();
  void show(const std::string& text);
  std::string what_;
  bool quiet_, terminal_, shown_ = false;
  std::chrono::steady_clock::time_point start_, last_;
};

}  // namespace remote_touch
