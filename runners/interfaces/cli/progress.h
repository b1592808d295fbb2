// Progress on stderr, apart from results on stdout.
#pragma once

#include <chrono>
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace remote_touch {

// Returns "25 %, 2.5 %/s, 30 s left"; only "25 %" if the fraction or the time is 0.
std::string progress_text(double fraction, double elapsed_s);
// The same for counted things. `earlier` of them were done before this program began: "30 of 100 runs, 2/s,
// 35 s left".
std::string progress_text(std::size_t done, std::size_t total, std::size_t earlier, const char* things,
                          double elapsed_s);

// Overwrites one line on a terminal, and prints a line every ten seconds elsewhere. Only one thread at a time
// may use it.
class Progress {
 public:
  // Prints all later progress as JSON for other programs, one object in a line, at most once a
  // second:
  //   {"what": "map.json", "done": 30, "total": 100, "elapsed_s": 15.2, "left_s": 35.4}
  // done and total are missing where there is only a text, left_s where it is not known.
  static void use_json() { is_json_ = true; }
  Progress(std::string what, bool quiet);
  ~Progress();
  void update(double fraction);  // 0 to 1
  void update(const std::string& text);
  void clear();  // call it before something else is printed
  void update(std::size_t done, std::size_t total, std::size_t earlier, const char* things);

 private:
  bool is_due();
  void print_json(nlohmann::ordered_json json) const;
  double elapsed_s() const { return std::chrono::duration<double>(last_ - start_).count(); }
  void show(const std::string& text);
  static inline bool is_json_ = false;
  std::string what_;
  bool quiet_, terminal_, shown_ = false;
  std::chrono::steady_clock::time_point start_, last_;
};

}  // namespace remote_touch
