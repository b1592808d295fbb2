#include "scenarios/synthetic/panel_scene.h"

namespace remote_touch {

PointCloud PanelScene::cloud(int frame) const {
  PointCloud cloud;
  const std::vector<FlatPanel> all = panels(captured_s(frame));
  for (const FlatPanel& panel : all) append(cloud, panel, grid_);
  if (all.size() == 1) cloud.grid_columns = columns(all.front(), grid_);  // else rows have several widths
  return cloud;
}

double PanelScene::signed_distance(const Vec3& p_W, double time_s) const {
  return remote_touch::signed_distance(panels(time_s), p_W);
}

std::optional<Vec3> PanelScene::plane_normal(double time_s) const {
  const std::vector<FlatPanel> all = panels(time_s);
  if (all.size() != 1) return {};
  return all.front().normal;
}

}  // namespace remote_touch
