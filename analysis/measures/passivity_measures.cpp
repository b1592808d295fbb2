#include "analysis/measures/passivity_measures.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace remote_touch {

namespace {

constexpr double kNoCycle = std::numeric_limits<double>::quiet_NaN();

// From tick i until the next.
double work_J(const Trace& trace, std::size_t i) {
  return trace.force_N[i].dot(trace.hip_position_m[i + 1] - trace.hip_position_m[i]);
}

// Of each piece that begins and ends with an update and has a force.
std::vector<double> work_between_updates_J(const Trace& trace) {
  std::vector<double> pieces;
  double work = 0;
  bool begun = false, felt = false;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    if (trace.frame_update(i)) {
      if (begun && felt) pieces.push_back(work);
      work = 0, begun = true, felt = false;
    }
    felt |= !trace.force_N[i].isZero(0);
    if (i + 1 < trace.length()) work += work_J(trace, i);
  }
  return pieces;
}

}  // namespace

double max_energy_injected_J(const Trace& trace) {
  double given = 0, max = 0;
  for (std::size_t i = 0; i + 1 < trace.length(); ++i) {
    given += work_J(trace, i);
    max = std::max(max, given);
  }
  return max;
}

double mean_energy_per_update_J(const Trace& trace) {
  const std::vector<double> pieces = work_between_updates_J(trace);
  double sum = 0;
  for (const double piece : pieces) sum += piece;
  return pieces.empty() ? kNoCycle : sum / static_cast<double>(pieces.size());
}

double max_energy_per_update_J(const Trace& trace) {
  const std::vector<double> pieces = work_between_updates_J(trace);
  return pieces.empty() ? kNoCycle : *std::max_element(pieces.begin(), pieces.end());
}

}  // namespace remote_touch
