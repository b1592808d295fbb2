#include "analysis/trace/tolerance.h"

#include <cmath>

namespace remote_touch {

Tolerance tolerance_of(const Tolerances& tolerances, const std::string& name) {
  for (const std::string& key : {name, std::string("*")})
    if (const auto found = tolerances.find(key); found != tolerances.end()) return found->second;
  return {};
}

bool within(const Tolerance& tolerance, double baseline, double candidate) {
  if (std::isnan(baseline) || std::isnan(candidate)) return std::isnan(baseline) && std::isnan(candidate);
  if (baseline == candidate) return true;
  if (!std::isfinite(baseline) || !std::isfinite(candidate)) return false;
  return std::abs(candidate - baseline) <= tolerance.absolute + tolerance.relative * std::abs(baseline);
}

}  // namespace remote_touch
