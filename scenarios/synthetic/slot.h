// Two parallel walls. A bar between them that is rotated about y stops at an angle that is known in closed
// form: a bar of 80 x 10 mm in a slot of 40 mm stops at 22.62 degrees, with its corners at x = +-35 mm.
#pragma once

#include <string>

#include "core/parameters/parameter.h"
#include "scenarios/synthetic/panel_scene.h"

namespace remote_touch {

class Slot final : public PanelScene {
 public:
  struct Settings {
    double width_m = 0.040;
    double length_m = 0.12;
    double height_m = 0.06;
    // The columns are at even millimetres: +-35 mm is half way between two, the worst position for a corner.
    double spacing_m = 0.002;
    double phase_m = 0;
  };

  Slot(const Settings& settings, const NoiseKey&, const Kernels&)
      : PanelScene({settings.spacing_m, settings.phase_m, 0}), settings_(settings) {}
  std::vector<FlatPanel> panels(double time_s) const override;  // wall at -z, then wall at +z

 private:
  const Settings settings_;
};

Parameters parameters(Slot::Settings& s);
inline std::string validate(const Slot::Settings&) {
  return {};
}

}  // namespace remote_touch
