#include "scenarios/panel_scene.h"

namespace remote_touch {

PointCloud PanelScene::cloud(int frame) const {
  PointCloud cloud;
  for (const FlatPanel& panel : panels(captured_s(frame))) append(cloud, panel, grid());
  return cloud;
}

double PanelScene::signed_distance(const Vec3& p_W, double time_s) const {
  return remote_touch::signed_distance(panels(time_s), p_W);
}

}  // namespace remote_touch
