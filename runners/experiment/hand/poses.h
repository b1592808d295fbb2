// A device with six degrees of freedom that visits listed poses.
#pragma once

#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "runners/experiment/hand/trajectory.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

class Poses final : public Trajectory {
 public:
  struct Settings {
    // Each row has x, y, z in metres, the orientation of the tool as a rotation vector in degrees (axis times
    // angle, in the world frame), and the duration in s of the motion to this pose; 0 jumps. The first row is
    // the start; its duration is not used.
    std::vector<double> poses{0, 0, 0, 0, 0, 0, 0};
  };

  Poses(const Settings& settings, const Scenario& scenario);
  // The device moves at constant speed along the straight line, and turns about a fixed axis by the smaller
  // angle.
  DeviceState at(double time_s) const override;
  double duration_s() const override { return arrival_s_.back(); }

 private:
  std::vector<DeviceState> poses_;
  std::vector<double> arrival_s_;
  std::vector<Vec3> rotation_W_;  // rotation vector from the pose before to each pose
};

Parameters parameters(Poses::Settings& s);
std::string validate(const Poses::Settings& s);

}  // namespace remote_touch
