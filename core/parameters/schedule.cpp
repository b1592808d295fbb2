#include "core/parameters/schedule.h"

namespace remote_touch {

double scheduled(const std::vector<double>& rows, double time_s) {
  if (rows.empty()) return 1;
  std::size_t next = 0;  // index of the first row after time_s
  while (next < rows.size() && rows[next] <= time_s) next += 2;
  if (next == 0) return rows[1];
  const double before_s = rows[next - 2], before = rows[next - 1];
  if (next == rows.size()) return before;
  return before + (time_s - before_s) / (rows[next] - before_s) * (rows[next + 1] - before);
}

std::string validate_schedule(const std::vector<double>& rows, const std::string& name,
                              const std::string& what) {
  for (std::size_t i = 0; i < rows.size(); i += 2) {
    if (rows[i + 1] > 1) return name + ": " + what + " " + std::to_string(rows[i + 1]) + ": expected 0 to 1";
    if (i > 0 && rows[i] < rows[i - 2])
      return name + ": time " + std::to_string(rows[i]) + ": expected no earlier than the row before";
  }
  return {};
}

}  // namespace remote_touch
