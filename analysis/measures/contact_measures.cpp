#include "analysis/measures/contact_measures.h"

#include <cmath>

#include "analysis/measures/no_value.h"
#include "analysis/trace/trace.h"

namespace remote_touch {

namespace {

bool has_force(const Trace& trace, std::size_t i) {
  return !trace.force_N[i].isZero(0);
}

// Mean of value(height) over the ticks that end in contact and have a known truth. The height is that of the
// rendered surface above the true one.
template <class Value>
double mean_in_contact(const Trace& trace, Value&& value) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    const double height = trace.signed_distance_m[i] - trace.nearest_distance_m[i];
    if (trace.state[i] != static_cast<std::int32_t>(ContactState::contact) || !std::isfinite(height))
      continue;
    sum += value(height), ++count;
  }
  return count == 0 ? kNoValue : sum / count;
}

// Mean of value(distance) over the ticks with a force and a known truth. The distance is that of the centre
// from the true surface.
template <class Value>
double mean_with_force(const Trace& trace, Value&& value) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < trace.length(); ++i)
    if (has_force(trace, i) && std::isfinite(trace.signed_distance_m[i]))
      sum += value(trace.signed_distance_m[i]), ++count;
  return count == 0 ? kNoValue : sum / count;
}

}  // namespace

double mean_height_m(const Trace& trace) {
  return mean_in_contact(trace, [](double height) { return height; });
}

double height_sd_m(const Trace& trace) {
  const double mean = mean_height_m(trace);
  const double variance =
      mean_in_contact(trace, [mean](double height) { return (height - mean) * (height - mean); });
  return std::isnan(variance) ? kNoValue : std::sqrt(variance);
}

double mean_distance_m(const Trace& trace) {
  return mean_with_force(trace, [](double distance) { return distance; });
}

double distance_sd_m(const Trace& trace) {
  const double mean = mean_distance_m(trace);
  const double variance =
      mean_with_force(trace, [mean](double distance) { return (distance - mean) * (distance - mean); });
  return std::isnan(variance) ? kNoValue : std::sqrt(variance);
}

double end_distance_m(const Trace& trace) {
  return trace.length() == 0 ? kNoValue : trace.signed_distance_m.back();
}

double force_fraction(const Trace& trace) {
  double count = 0;
  for (std::size_t i = 0; i < trace.length(); ++i) count += has_force(trace, i) ? 1 : 0;
  return trace.length() == 0 ? 0 : count / static_cast<double>(trace.length());
}

double last_force_time_s(const Trace& trace) {
  for (std::size_t i = trace.length(); i > 0; --i)
    if (has_force(trace, i - 1)) return trace.time_s[i - 1];
  return kNoValue;
}

}  // namespace remote_touch
