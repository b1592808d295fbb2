#include "core/virtual_fixtures/everywhere.h"

namespace remote_touch {

Parameters parameters(Everywhere::Settings& s) {
  return parameters(s.values);
}

std::string conflict(const Everywhere::Settings& s) {
  return conflict(s.values);
}

std::vector<double> Everywhere::shares(const PointCloud& cloud) const {
  std::vector<double> shares(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) shares[i] = cloud.point(i).allFinite() ? 1 : 0;
  return shares;
}

}  // namespace remote_touch
