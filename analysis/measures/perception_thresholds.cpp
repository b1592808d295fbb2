#include "analysis/measures/perception_thresholds.h"

#include <cmath>

namespace remote_touch {

namespace {

constexpr PerceptionThreshold kThresholds[] = {
    {"max_relative_jump", "1", 0.07,
     "the change of a constant force of 2.5 to 10 N that is just noticed, as a fraction of the force",
     "X. D. Pang, H. Z. Tan, N. I. Durlach, Manual discrimination of force using active finger motion, 1991"},
    {"apparent_friction", "1", 0.056,
     "the difference of two coefficients of friction of a force-feedback device that is just noticed, at a "
     "coefficient of 0.2, the smallest one tested",
     "W. R. Provancher, N. D. Sylvester, Fingerpad skin stretch increases the perception of virtual "
     "friction, 2009"},
};

}  // namespace

std::span<const PerceptionThreshold> perception_thresholds() {
  return kThresholds;
}

bool is_below(const PerceptionThreshold& threshold, double value) {
  return std::abs(value) < threshold.value;
}

}  // namespace remote_touch
