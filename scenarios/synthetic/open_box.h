// A box that is open at the top, seen from inside: the scene of 6.3.1 and Fig 6.3.
#pragma once

#include <string>

#include "core/parameters/parameter.h"
#include "scenarios/synthetic/panel_scene.h"

namespace remote_touch {

class OpenBox final : public PanelScene {
 public:
  struct Settings {
    Vec3 size_m{0.110, 0.040, 0.090};  // inside, x, y (up), z; the middle is the origin
    double spacing_m = 0.003;
    bool floor = true;
  };

  OpenBox(const Settings& settings, const NoiseKey&, const Kernels&)
      : PanelScene({settings.spacing_m}), settings_(settings) {}
  // Walls at -x, +x, -z, +z, then the floor.
  std::vector<FlatPanel> panels(double time_s) const override;

 private:
  const Settings settings_;
};

Parameters parameters(OpenBox::Settings& s);
inline std::string validate(const OpenBox::Settings& s) {
  return s.size_m.minCoeff() > 0 ? "" : "size_m: expected above 0 along every axis";
}

}  // namespace remote_touch
