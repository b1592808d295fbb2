// A simulated hand and its haptic device: the exact motion of the hand during one tick, in which the device
// holds the force, without and with dry friction; what the device measures and exerts; and the operator.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "analysis/trace/trace.h"
#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/parameters/parameter.h"
#include "core/points/vector.h"
#include "core/rendering/frames_and_outputs.h"

namespace remote_touch {

// The exact motion of a mass on a spring and dampers during one tick. The force on the mass is held, and the
// path that the mass follows moves at constant velocity. This models a hand whose device holds its force for
// a tick.

// m x'' = F + k (p - x) + c_p (p' - x') - c_g x' along every axis; p is the path. SI units. For rotations x
// and p are rotation vectors, m is the moment of inertia, F is the torque, and k, c_p and c_g are the
// rotational stiffness and damping.
struct MassOnSpring {
  double mass = 1;            // m, above 0
  double stiffness = 0;       // k, to the path
  double path_damping = 0;    // c_p, to the path
  double ground_damping = 0;  // c_g, to the ground: of the device's joints, or of a hand that opens
};

// The energies of one step, J. The first two are supplied. The others are dissipated or stored.
struct StepEnergy {
  double force_work_J = 0;     // done by the held force: force . displacement
  double path_work_J = 0;      // done by what moves the path
  double path_damper_J = 0;    // dissipated; negative by rounding only
  double ground_damper_J = 0;  // dissipated; negative by rounding only
  double dry_friction_J = 0;   // dissipated; see DryFrictionStep
  double kinetic_J = 0;        // gained by the mass
  double potential_J = 0;      // gained by the spring

  double supplied_J() const { return force_work_J + path_work_J; }
  double dissipated_J() const { return path_damper_J + ground_damper_J + dry_friction_J; }
  double gained_J() const { return kinetic_J + potential_J; }
  StepEnergy& operator+=(const StepEnergy& other);
};

// One step of a given duration T. The constructor computes its coefficients with +, -, *, / and square roots
// only, so their bits do not depend on the C library.
//
// Let w = k / m and d = (c_p + c_g) / m. phi is the response to a unit impulse: phi'' + d phi' + w phi = 0,
// phi(0) = 0, phi'(0) = 1. psi is the integral of phi, and chi the integral of psi. Then
//   x(T) - x(0) = x'(0) phi + r psi + w p' chi,   x'(T) = x'(0) phi' + r phi + w p' psi,
//   phi' = 1 - w psi - d phi,   r = (F + k (p(0) - x(0)) + c_p p') / m.
//
// The errors of phi, psi and chi, relative to their largest values in [0, T], and the error of phi', relative
// to 1, are below 1e-13 for sqrt(w) T <= 32 and (d + sqrt(w)) T < 2^18. held_motion.cpp has the
// derivation. One tick of every hand that the settings accept is within these limits.
class HeldForceStep {
 public:
  // pre: mass > 0, the other numbers >= 0, all finite, duration_s > 0.
  HeldForceStep(const MassOnSpring& system, double duration_s);

  // The state at the beginning of the step, and the quantities that are constant during it.
  struct Start {
    Vec3 apart = Vec3::Zero();          // p - x
    Vec3 velocity = Vec3::Zero();       // x'
    Vec3 path_velocity = Vec3::Zero();  // p'
    Vec3 force = Vec3::Zero();          // F
  };
  struct Motion {
    Vec3 displacement;  // x(T) - x(0)
    Vec3 velocity;      // x'(T)
  };
  Motion motion(const Start& start) const;
  // Returns the energies of the step, in closed form. Gained plus dissipated energy is the supplied energy,
  // within rounding. It is slower than motion(), because each call computes the integrals of the squared
  // velocities.
  StepEnergy energy(const Start& start) const;

 private:
  Vec3 pull(const Start& start) const;

  MassOnSpring system_;
  double duration_s_;
  double w_, d_;
  double phi_, psi_, chi_;
  double slope_;  // phi'(T)
};

// The exact motion of a mass on a spring and dampers with dry (Coulomb) friction during one tick. Like
// HeldForceStep, this models a hand whose device holds its force for a tick; the joints of the device rub.
// m x'' = F + k (p - x) + c_p (p' - x') - c_g x' - F_c sign(x') along every axis, each axis by itself. A mass
// at rest stays at rest while the other forces on an axis are at most F_c. For rotations F_c is a torque.
class DryFrictionStep {
 public:
  // pre: as for HeldForceStep; friction >= 0.
  DryFrictionStep(const MassOnSpring& system, double friction, double duration_s);

  // A tick is divided at every time at which the velocity of an axis becomes 0 or a mass at rest starts to
  // move. Between them the motion is that of HeldForceStep. The times are found by bisection, down to the
  // resolution of a double. The velocity is exactly 0 after a stop.
  HeldForceStep::Motion motion(const HeldForceStep::Start& start) const;
  // Returns the energies of the step. Gained plus dissipated energy is the supplied energy, within rounding.
  StepEnergy energy(const HeldForceStep::Start& start) const;

 private:
  struct Axis;
  void advance(Axis& axis, StepEnergy* energy) const;
  void rest(Axis& axis, double duration_s, StepEnergy* energy) const;
  void slide(Axis& axis, double direction, double duration_s, StepEnergy* energy) const;
  Axis after(const Axis& axis, double direction, double duration_s) const;
  double acceleration(const Axis& axis, double direction) const;
  double sliding_time(const Axis& axis, double direction, double longest_s) const;

  MassOnSpring system_;
  double friction_, duration_s_;
};

// A haptic device that senses all six axes and has motors for some of them, such as the five of the device of
// 7.5.
struct MotorSettings {
  bool force_x = true, force_y = true, force_z = true;
  bool torque_x = true, torque_y = true, torque_z = true;
  double max_force_N = 0;
  double max_torque_Nm = 0;
};

Parameters parameters(MotorSettings& s);

// Returns the wrench that the device exerts on the hand for a commanded one. Forces act along the base axes,
// and torques about the axes of the handle, which are those of the tool. Components on axes without a motor
// are 0. The force is limited to max_force_N and the torque to max_torque_Nm; 0: no limit.
Wrench exerted(const MotorSettings& motors, const Eigen::Quaterniond& handle_W, const Wrench& commanded);

// The settings of a simulated haptic device: its motors, the resistance of its joints, its sensors and the
// delay of its loop.

// Friction and damping of the joints against the ground, the same along all axes. They move only a hand that
// has a mass, so they need an operator.
struct DeviceResistance {
  double friction_N = 0, friction_torque_Nm = 0;  // dry (Coulomb) friction
  double damping_Ns_per_m = 0, rotational_damping_Nms_per_rad = 0;
};

struct DeviceSettings {
  MotorSettings motors;
  DeviceResistance resistance;
  double position_resolution_m = 0;
  double angle_resolution_deg = 0;
  int delay_ticks = 0;
  double contact_damping_Ns_per_m = 0;
  int velocity_ticks = 1;
};

Parameters parameters(DeviceSettings& s);
std::string validate(const DeviceSettings& s);

// The haptic device between the hand and the renderer: what it measures of the pose of the hand, and which
// wrench it exerts for the commanded one.
class DeviceModel {
 public:
  DeviceModel(const DeviceSettings& settings, double tick_s);

  // Returns the pose that the device measures for the pose of the hand. The coordinates of the position and
  // of the rotation vector are rounded to multiples of the resolutions. Must be called once per tick.
  DeviceState measured(const DeviceState& hand);

  // Returns the wrench that the device exerts from now to the next tick, for the command that the renderer
  // has computed from the last measured pose. Must be called once per tick, after measured(). The device adds
  // contact damping -B v, where v is the measured velocity, to a command with a force. It exerts the command
  // of delay_ticks ticks ago, and no wrench before the first command arrives. See exerted() for the motors.
  // Does not allocate memory.
  Wrench exerted_for(const Wrench& command);

 private:
  Vec3 measured_velocity() const;

  const DeviceSettings s_;
  const double tick_s_;
  Eigen::Quaterniond handle_W_ = Eigen::Quaterniond::Identity();  // measured orientation
  // Rings of the newest velocity_ticks + 1 measured positions and of the newest delay_ticks + 1 commands. The
  // entry of tick i is at i modulo the size.
  std::vector<Vec3> positions_;
  std::vector<Wrench> commands_;
  std::size_t position_count_ = 0, command_count_ = 0;  // so far
};

// A simulated operator: the hand is a mass that springs and dampers pull to the intended path, and that the
// device's force moves. The dissertation does not have this model, because its operators were people.

struct OperatorSettings {
  double mass_kg = 0.5;
  double inertia_kg_m2 = 1e-3;
  double stiffness_N_per_m = 300;
  double damping_Ns_per_m = 15;
  double rotational_stiffness_Nm_per_rad = 1;
  double rotational_damping_Nms_per_rad = 0.05;
  std::vector<double> grip{};
  std::vector<double> presses{};
};

Parameters parameters(OperatorSettings& s);
std::string validate(const OperatorSettings& s);

// m x'' = f + g k (x_i - x) + c (g x_i' - x') - b x' - F_c sign(x'), with f the device's force, x_i the
// intended position, g the grip, and b and F_c the damping and the dry friction of the device. The hand's
// spring and damper to the intended position are g k and g c, and (1 - g) c damps the motion of a hand that
// opens. Rotations have the same form. They are rotation vectors in world axes relative to the
// pose at the beginning of the tick, and the inertia is inertia_kg_m2 about every axis.
//
// f and g are constant in a tick, and x_i is linear in time. The solution is exact (HeldForceStep, and
// DryFrictionStep with friction; friction acts along every axis by itself). The
// device is a zero-order hold, which adds energy to a hand that a spring pushes. So a stiff device can make
// the hand unstable.
class OperatorModel {
 public:
  OperatorModel(const OperatorSettings& settings, double tick_s, const DeviceResistance& device = {});

  // Returns the hand's pose at time_s. intended: the path's pose at time_s. device_wrench: the wrench that
  // the device has exerted since the last call. If the last call was n ticks ago, the hand makes one step of
  // n ticks. The first call puts the hand onto the path, at rest. Buttons come from the settings.
  DeviceState move(const DeviceState& intended, double time_s, const Wrench& device_wrench);

  // Returns the energies of the last step, translation plus rotation; zero before the second call. A change
  // of the grip between two ticks adds energy to the springs: half the change of the stiffness times the
  // squared distance. This energy is not included.
  StepEnergy last_energy() const;

 private:
  // The step of the translation, or of the rotation, without and with dry friction of the device.
  using Step = std::variant<HeldForceStep, DryFrictionStep>;
  static Step step(const MassOnSpring& system, double friction, double duration_s);
  void prepare(double grip, double duration_s);
  std::uint32_t buttons(double time_s) const;

  const OperatorSettings s_;
  const DeviceResistance device_;
  const double tick_s_;
  ToolPose pose_, intended_;  // poses at the last call
  Vec3 velocity_ = Vec3::Zero(), angular_velocity_ = Vec3::Zero();
  std::optional<double> last_time_s_;

  // The last step, for translation and rotation, and the grip, duration and start for which it was computed.
  std::optional<Step> step_, turning_step_;
  double grip_ = 0, duration_s_ = 0;
  HeldForceStep::Start start_, turning_start_;
};

// The hand that moves the device of a run: a script alone, or a simulated operator who follows it and feels
// the device's motors.
class SimulatedHand {
 public:
  // If there is no operator, the hand follows the script exactly. If there are no device settings, the device
  // measures the hand's pose exactly and exerts the whole command at once.
  SimulatedHand(const std::optional<OperatorSettings>& operator_settings,
                const std::optional<DeviceSettings>& device, double tick_s);

  // True if there is no operator and the device measures exactly: the measured pose is then always the
  // intended one.
  bool follows_script() const { return !operator_model_ && !rounds_; }
  // Moves the hand to the time of the next tick. Returns the pose that the device measures.
  DeviceState move(const DeviceState& intended, double time_s);
  // Computes the wrench that the device exerts for a command. It moves the hand in the next tick.
  void apply(const Wrench& command);
  // Returns the state after the last tick; none if there are neither operator nor device settings.
  std::optional<HandState> state() const;

 private:
  std::optional<OperatorModel> operator_model_;
  const bool has_device_, rounds_;
  DeviceModel device_;
  ToolPose intended_, hand_;
  Wrench device_wrench_;
};

}  // namespace remote_touch
