// A scene of panels that rest or move, each sampled as a grid of points with normals.
#pragma once

#include <vector>

#include "scenarios/interface/scenario.h"
#include "scenarios/synthetic/panel.h"

namespace remote_touch {

class PanelScene : public Scenario {
 public:
  double frame_rate_hz() const override { return 30; }
  int frame_count() const override { return 1; }
  // The panels as they are when the frame is captured.
  PointCloud cloud(int frame) const override;
  // Distance to the panels at time_s, also between frames. NaN for a position that is behind a panel and
  // beyond its border.
  double signed_distance(const Vec3& p_W, double time_s) const override;
  // Returns the normal of a scene with one panel. Empty for other scenes.
  std::optional<Vec3> plane_normal(double time_s) const override;

  virtual std::vector<FlatPanel> panels(double time_s) const = 0;

 protected:
  explicit PanelScene(const PanelGrid& grid) : grid_(grid) {}

 private:
  const PanelGrid grid_;
};

}  // namespace remote_touch
