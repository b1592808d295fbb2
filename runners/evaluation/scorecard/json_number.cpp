#include "runners/evaluation/scorecard/json_number.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace remote_touch {

Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

}  // namespace remote_touch
