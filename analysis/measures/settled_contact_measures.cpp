#include "analysis/measures/settled_contact_measures.h"

#include <algorithm>
#include <cmath>

#include "analysis/measures/contact_force.h"
#include "analysis/measures/no_value.h"
#include "analysis/statistics/extremes.h"
#include "analysis/trace/trace.h"

namespace remote_touch {

namespace {

// Tolerance for rounded times: without it a settling of 100 ticks could last 101 ticks.
constexpr double kSameTime_s = 5e-7;

// Calls act(i) for every settled tick.
template <class Act>
void for_each_settled(const Trace& trace, Act&& act) {
  double below_since_s = kNoValue;
  for (std::size_t i = 0; i < trace.contact.size(); ++i) {
    if (trace.frame_index[i] < 0 || !(trace.contact[i].hip_distance_m < 0)) {  // or NaN: not known
      below_since_s = kNoValue;
      continue;
    }
    if (std::isnan(below_since_s)) below_since_s = trace.time_s[i];
    if (trace.time_s[i] - below_since_s >= kSettling_s - kSameTime_s) act(i);
  }
}

// The maximum of value(height) over the settled ticks with a known truth.
template <class Value>
double max_of_heights(const Trace& trace, Value&& value) {
  double max = kNoValue;
  for_each_settled(trace, [&](std::size_t i) {
    const double height = trace.contact[i].height_m;
    if (!std::isnan(height)) max = std::isnan(max) ? value(height) : max_or_nan(max, value(height));
  });
  return max;
}

// Mean of value(contact) over the settled ticks in which it is not NaN; NaN if there is none.
template <class Value>
double settled_mean(const Trace& trace, Value&& value) {
  double sum = 0, count = 0;
  for_each_settled(trace, [&](std::size_t i) {
    const double here = value(trace.contact[i]);
    if (!std::isnan(here)) sum += here, ++count;
  });
  return count == 0 ? kNoValue : sum / count;
}

// Fraction of the settled ticks whose index satisfies the condition; NaN if no tick settled.
template <class Condition>
double settled_fraction(const Trace& trace, Condition&& holds) {
  double count = 0, all = 0;
  for_each_settled(trace, [&](std::size_t i) { count += holds(i) ? 1 : 0, ++all; });
  return all == 0 ? kNoValue : count / all;
}

}  // namespace

double max_contact_error_m(const Trace& trace) {
  return max_of_heights(trace, [](double height) { return std::abs(height); });
}

double max_sink_m(const Trace& trace) {
  return max_of_heights(trace, [](double height) { return std::max(0.0, -height); });  // no NaN
}

double max_float_m(const Trace& trace) {
  return max_of_heights(trace, [](double height) { return std::max(0.0, height); });  // no NaN
}

double rms_contact_error_m(const Trace& trace) {
  return std::sqrt(
      settled_mean(trace, [](const Trace::TrueContact& at) { return at.height_m * at.height_m; }));
}

double rms_renderer_error_m(const Trace& trace) {
  return std::sqrt(settled_mean(trace, [](const Trace::TrueContact& at) {
    return std::isnan(at.height_m) ? kNoValue : at.measured_height_m * at.measured_height_m;
  }));
}

double rms_camera_error_m(const Trace& trace) {
  return std::sqrt(settled_mean(trace, [](const Trace::TrueContact& at) {
    const double error_m = at.height_m - at.measured_height_m;
    return error_m * error_m;
  }));
}

double mean_camera_error_m(const Trace& trace) {
  return settled_mean(trace, [](const Trace::TrueContact& at) { return at.height_m - at.measured_height_m; });
}

double contact_force_fraction(const Trace& trace) {
  return settled_fraction(trace, [&](std::size_t i) { return has_contact_force(trace, i); });
}

double contact_known_fraction(const Trace& trace) {
  return settled_fraction(trace, [&](std::size_t i) { return !std::isnan(trace.contact[i].height_m); });
}

}  // namespace remote_touch
