// Two walls that lean apart and close on a tool between them, until no motion obeys all constraints and (6.8)
// is infeasible.
#pragma once

#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "scenarios/synthetic/panel_scene.h"

namespace remote_touch {

class Wedge final : public PanelScene {
 public:
  struct Settings {
    double angle_deg = 60;
    double length_m = 0.16;
    double height_m = 0.12;
    double spacing_m = 0.002;
    double open_gap_m = 0.05;
    double closed_gap_m = 0;
    double close_start_s = 1;
    double close_end_s = 2;
    double open_start_s = 3;
    double open_end_s = 4;
    double offset_m = 0;
    double tilt_deg = 0;
    double frame_rate_hz = 30;
  };

  Wedge(const Settings& settings, const NoiseKey&, const Kernels&);
  double frame_rate_hz() const override { return settings_.frame_rate_hz; }
  int frame_count() const override { return frame_count_; }
  // Returns the closing and the opening of the walls. Empty if the gap is constant.
  std::vector<Phase> phases() const override;
  std::vector<FlatPanel> panels(double time_s) const override;  // wall at -z, then wall at +z
  // Distance between the lower edges of the walls, m; linear in time while it changes.
  double gap_m(double time_s) const;

 private:
  const Settings settings_;
  int frame_count_;
  Vec3 up_, across_;      // axes of the wedge: y and z, tilted about x
  double sine_, cosine_;  // sine and cosine of half the angle
};

Parameters parameters(Wedge::Settings& s);
std::string validate(const Wedge::Settings& s);

}  // namespace remote_touch
