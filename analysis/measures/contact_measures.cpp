#include "analysis/measures/contact_measures.h"

#include <cmath>

#include "analysis/measures/contact_force.h"
#include "analysis/measures/no_value.h"
#include "analysis/statistics/mean.h"
#include "analysis/trace/trace.h"

namespace remote_touch {

namespace {

// Height of the rendered surface above the true one.
double height_m(const Trace& trace, std::size_t i) {
  return trace.signed_distance_m[i] - trace.nearest_distance_m[i];
}

// Mean of value(height) over the ticks that end in contact, have a known truth and something near the proxy.
// NaN if a distance to the nearest point is unknown.
template <class Value>
double mean_in_contact(const Trace& trace, Value&& value) {
  const auto qualifies = [&](std::size_t i) {
    return trace.state[i] == static_cast<std::int32_t>(ContactState::contact) &&
           std::isfinite(trace.signed_distance_m[i]) && !std::isinf(trace.nearest_distance_m[i]);
  };
  return mean_where(trace.length(), qualifies, [&](std::size_t i) { return value(height_m(trace, i)); });
}

// Mean of value(distance) over the ticks with a force and a known truth. The distance is that of the centre
// from the true surface.
template <class Value>
double mean_with_force(const Trace& trace, Value&& value) {
  const auto qualifies = [&](std::size_t i) {
    return has_contact_force(trace, i) && std::isfinite(trace.signed_distance_m[i]);
  };
  return mean_where(trace.length(), qualifies,
                    [&](std::size_t i) { return value(trace.signed_distance_m[i]); });
}

double root(double mean_square) {
  return std::isnan(mean_square) ? kNoValue : std::sqrt(mean_square);
}

}  // namespace

double mean_height_m(const Trace& trace) {
  return mean_in_contact(trace, [](double height) { return height; });
}

double height_sd_m(const Trace& trace) {
  const double mean = mean_height_m(trace);
  return root(mean_in_contact(trace, [mean](double height) { return (height - mean) * (height - mean); }));
}

double rms_surface_error_m(const Trace& trace) {
  return root(mean_in_contact(trace, [](double height) { return height * height; }));
}

double mean_distance_m(const Trace& trace) {
  return mean_with_force(trace, [](double distance) { return distance; });
}

double distance_sd_m(const Trace& trace) {
  const double mean = mean_distance_m(trace);
  return root(mean_with_force(trace, [mean](double d) { return (d - mean) * (d - mean); }));
}

double end_distance_m(const Trace& trace) {
  return trace.length() == 0 ? kNoValue : trace.signed_distance_m.back();
}

double force_fraction(const Trace& trace) {
  double count = 0;
  for (std::size_t i = 0; i < trace.length(); ++i) count += has_contact_force(trace, i) ? 1 : 0;
  return trace.length() == 0 ? 0 : count / static_cast<double>(trace.length());
}

double last_force_time_s(const Trace& trace) {
  for (std::size_t i = trace.length(); i > 0; --i)
    if (has_contact_force(trace, i - 1)) return trace.time_s[i - 1];
  return kNoValue;
}

}  // namespace remote_touch
