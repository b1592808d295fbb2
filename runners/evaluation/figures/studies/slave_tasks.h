// The tasks of the figures with a slave. All are the experiment steer-robot with other settings; the points
// have no noise unless a function says so, and the scene is the true surface at all times.
#pragma once

#include <string>
#include <vector>

#include "runners/experiment/catalog/experiment.h"

namespace remote_touch {

struct RemoteSide {
  double frequency_hz = 2;  // natural frequency of the slave
  double delay_s = 0;       // of the commands, and of the forces
  std::string feedback = "rendered";
  double region_m = 0;  // radius of the forbidden region
};

// The settings of steer-robot, with its defaults, that derivations use. No task changes them, except that
// contour_task() has a softer contact.
inline constexpr double kSlaveMass_kg = 2, kSlaveRadius_m = 0.005;
inline constexpr double kSlaveStiffness_N_per_m = 30000;
inline constexpr double kHandMass_kg = 0.5, kHandStiffness_N_per_m = 300, kHandDamping_Ns_per_m = 15;
inline constexpr double kPointSpacing_m = 0.0015, kSlaveFrameRate_hz = 30, kSlaveTick_s = 0.001;

// The values over which the figures are drawn; delays are those of each direction.
inline constexpr double kSlaveFrequencies_hz[] = {1, 2, 4, 8};
inline constexpr double kLinkDelays_s[] = {0, 0.05, 0.1, 0.2};

// Returns the height over a flat grid of points at which the command stops: a ball with the radius
// region_m + r_c rests in the middle of four points. r_c is equal to kSlaveRadius_m.
double stopped_height_m(double region_m);

// The HIP moves straight down to a plane at rest, at kApproach_m_per_s from from_m above it, and stops 20 mm
// below it. A hand with mass is pushed back by the force that it feels, up to 12 N, as much as an omega.3
// exerts. A hand without mass follows its path exactly.
inline constexpr double kApproach_m_per_s = 0.2, kApproachTo_m = -0.02;
Experiment approach_task(const RemoteSide& remote, double from_m, bool has_mass);

// The hand is lowered at kLowering_m_per_s into a plane, which then shakes with the amplitude kOrgan_m.
inline constexpr double kOrgan_m = 0.02, kLowering_m_per_s = 0.1;
Experiment organ_task(const RemoteSide& remote, double shake_hz, double noise_m,
                      std::vector<std::string> settings = {});

// Fig 4.12 with a slave: a plane rises at 0.1 m/s under a hand at rest for 0.5 s after it has touched the
// proxy, and then accelerates for kLift_s at 3 m/s^2.
inline constexpr double kLift_m_per_s2 = 3, kLiftFrom_s = 1, kLift_s = 1.0 / 3;
Experiment lift_task(const RemoteSide& remote);

// A hand with mass presses into a soft surface with waves, slides along it and back, and lifts.
inline constexpr double kContourStiffness_N_per_m = 2000, kContourDamping_Ns_per_m = 20, kContourGain = 0.5;
inline constexpr double kContour_s = 4;
Experiment contour_task(const RemoteSide& remote, const std::vector<std::string>& settings);

}  // namespace remote_touch
