#include "runners/presentation/view/shown_sensor.h"

#include <nlohmann/json.hpp>

namespace remote_touch {

Json json_of(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

// A camera looks along its z axis, and its y axis points down.
Json sensor_json(const RigidTransform& X_WC) {
  return {{"position_m", json_of(Vec3(X_WC.translation()))},
          {"forward", json_of(Vec3(X_WC.linear().col(2)))},
          {"up", json_of(Vec3(-X_WC.linear().col(1)))}};
}

}  // namespace remote_touch
