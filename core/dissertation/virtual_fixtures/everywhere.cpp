#include "core/dissertation/virtual_fixtures/everywhere.h"

namespace remote_touch {

Parameters parameters(Everywhere::Settings& s) {
  return parameters(s.values);
}

std::string validate(const Everywhere::Settings& s) {
  return validate(s.values);
}

std::vector<double> Everywhere::weights(const PointCloud& cloud) const {
  std::vector<double> weights(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) weights[i] = cloud.point(i).allFinite() ? 1 : 0;
  return weights;
}

}  // namespace remote_touch
