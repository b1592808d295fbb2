// One panel at rest, seen from one side only, to test contact from the back too.
#pragma once

#include <string>

#include "core/parameters/parameter.h"
#include "scenarios/synthetic/panel_scene.h"

namespace remote_touch {

class SinglePanel final : public PanelScene {
 public:
  struct Settings {
    Vec3 centre_m = Vec3::Zero();
    Vec3 normal = Vec3::UnitZ();  // any length
    double width_m = 0.15;
    double height_m = 0.15;
    double spacing_m = 0.002;
  };

  SinglePanel(const Settings& settings, const NoiseKey&, const Kernels&)
      : PanelScene({settings.spacing_m}), settings_(settings) {}
  std::vector<FlatPanel> panels(double time_s) const override;

 private:
  const Settings settings_;
};

Parameters parameters(SinglePanel::Settings& s);
inline std::string validate(const SinglePanel::Settings& s) {
  return s.normal.norm() > 0 ? "" : "normal = 0, 0, 0: expected any direction";
}

}  // namespace remote_touch
