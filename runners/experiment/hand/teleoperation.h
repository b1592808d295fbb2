// The remote side of a run: commands travel to a slave robot, and its forces travel back.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "analysis/trace/trace.h"
#include "core/parameters/parameter.h"
#include "core/points/noise.h"
#include "core/rendering/renderer.h"
#include "core/teleoperation/architecture.h"
#include "core/teleoperation/channel.h"
#include "core/teleoperation/slave.h"

namespace remote_touch {

// The settings of a run with teleoperation: the slave, the links to it and back, and what the hand feels.

// One direction of the connection: which samples are sent, and how they travel.
struct LinkSettings {
  ChannelSettings channel;
  DeadBandSettings dead_band;
};

Parameters parameters(LinkSettings& s);
std::string validate(const LinkSettings& s);

struct TeleoperationSettings {
  SlaveSettings slave;
  LinkSettings commands, forces;
  FeedbackSettings feedback;
  RegistrationError registration;
  // Mass of hand and device, with which passivity control and waves predict the motion of the hand; 0: not
  // known.
  double hand_mass_kg = 0;
  std::optional<SlaveTool> tool;  // tool of the slave; none: it is a ball
};

class Teleoperation {
 public:
  // key: of the noise of the channels and of the registration.
  Teleoperation(const TeleoperationSettings& settings, const NoiseKey& key, double tick_s,
                const SlaveScene& scene);

  // Returns the position that is sent to the slave, world frame: with rendered feedback the commanded
  // position of the renderer, else the HIP.
  Vec3 command(const DeviceState& device, const RenderOutput& out) const;
  // Returns the orientation that is sent with it: with rendered feedback that of the renderer's tool, if the
  // commanded position is that of the tool; else that of the device. Returns the identity if the slave has no
  // tool. NaN if the device has no orientation.
  Eigen::Quaterniond command_orientation(const DeviceState& device, const RenderOutput& out) const;

  // Must be called once per tick, after the renderer. Moves the slave to time_s with the command that it had
  // at the tick before, sends the new command and the slave's force, and receives what has arrived by
  // time_s. Returns the wrench that the device is commanded to exert until the next tick, world frame. The
  // slave starts, at rest, at the first command that is finite, whatever the delay. A command that is not
  // finite is not sent, and a position of the device that is not finite counts as the one before.
  //
  // The slave has a clock of its own. If the caller has skipped ticks, the slave first performs up to
  // kMaxMissedTicks of them, at their times: it moves, receives commands that were in transit, and sends its
  // forces. If more were skipped, it performs the last of them and stands still before. Allocates nothing,
  // unless the scene does.
  Wrench tick(const DeviceState& device, const RenderOutput& out, double time_s);

  static constexpr int kMaxMissedTicks = 20;

  // Returns the state after the last tick. Its peak force is the largest since the tick before, with the
  // ticks that were skipped. Before the first command all its numbers are NaN, except the counts of packets.
  // frame_packets is always 0: the caller counts the frames.
  const SlaveState& state() const { return state_; }

  // States the force that the device exerts from the last tick to the next one, with all its limits. Without
  // a call it is the force that tick() returned.
  void observe_exerted(const Vec3& force_N) { exerted_N_ = force_N; }

  // The energies at both ports since the start, see architecture.h. They are counted only if the hand is to
  // feel the slave.
  const PortEnergy& hand_energy() const { return ends_.hand->energy(); }
  const PortEnergy& slave_energy() const { return ends_.slave->energy(); }

 private:
  // A sample (a pose or a force), the message of the architecture, and the torque on a tool. The dead-band
  // compares only the sample.
  struct Packet {
    DeadBandSample sample = {};
    Message message = {};
    Vec3 torque_Nm = Vec3::Zero();
  };
  struct Link {
    // reach_m: see DeadBandSender.
    Link(const LinkSettings& settings, const NoiseKey& key, NoiseUse use, double tick_s, double reach_m);
    // rest: the packet without its sample.
    void send(const Vec3& value, const Eigen::Quaterniond& orientation_W, Packet rest, double time_s);
    void receive(double time_s);
    Channel<Packet> channel;
    DeadBandSender sender;
    DeadBandReceiver receiver;
    Packet newest;  // the packet that was received last
  };

  Vec3 in_axes_of_hand(const Vec3& v_W) const { return X_registration_.linear().transpose() * v_W; }
  // The force of the scene on the slave in the last tick, in the axes in which the hand works.
  Vec3 slave_force() const { return in_axes_of_hand(slave().force_N); }
  Vec3 in_frame_of_hand(const Vec3& p_W) const { return X_registration_.inverse() * p_W; }
  const Slave::State& slave() const { return tool_slave_ ? tool_slave_->state() : slave_.state(); }
  void move_slave(double time_s);
  double ticks_since_last(double time_s) const;
  void move_slave_until(double time_s, double ticks);
  void observe_slave();
  void observe_hand(const DeviceState& device, double ticks);
  Vec3 displacement_m(const DeviceState& device);
  void receive_command(double time_s);
  void send_force(double time_s);
  Wrench receive_wrench(double time_s);

  const TeleoperationSettings s_;
  const RigidTransform X_registration_;  // turns a position that is sent into where the slave goes
  const double tick_s_;
  Slave slave_;
  std::optional<ToolSlave> tool_slave_;  // instead of slave_
  Link commands_, forces_;
  Ends ends_;
  double last_s_ = 0;              // time of the last tick
  Vec3 exerted_N_ = Vec3::Zero();  // by the device since the last tick
  std::optional<Vec3> hand_W_;     // last finite position of the hand
  std::optional<Vec3> command_W_;  // the command for the coming tick of the slave
  Eigen::Quaterniond command_orientation_W_ = Eigen::Quaterniond::Identity();
  SlaveState state_;
};

// The frames that travel from the slave's camera to the operator: those that the dead-band lets pass.

// Decides which frames are sent. The dead-band compares a frame near the position that the slave had when the
// frame was captured.
class FrameSender {
 public:
  // The kernels must outlive it.
  FrameSender(const FrameDeadBandSettings& settings, const Kernels& kernels)
      : dead_band_(settings), kernels_(kernels) {}

  // Returns true if the frame has to be sent, and then keeps its points until the next one has to.
  bool sends(const Frame& frame) { return dead_band_.sends(frame, slave_at(frame.captured_s), kernels_); }
  // Must be called once per tick, after the slave has moved, with increasing times. slave_W: NaN before the
  // slave has started, as in a trace.
  void observe_slave(const Vec3& slave_W, double time_s) {
    if (slave_W.allFinite()) slave_.emplace_back(time_s, slave_W);
  }
  // Forgets where the slave was. Until it is observed again, every frame is sent.
  void lose_slave() { slave_.clear(); }
  // Returns the number of frames that had to be sent.
  int sent() const { return dead_band_.sent(); }

 private:
  // Returns nothing if the position at that time is not known.
  std::optional<Vec3> slave_at(double time_s);

  FrameDeadBand dead_band_;
  const Kernels& kernels_;
  std::deque<std::pair<double, Vec3>> slave_;  // times and positions since the newest frame was captured
};

// Passes the frames that are sent on to a receiver, which must outlive it. Latency, jitter and loss of the
// frames are those of the run. A frame that is lost on its way does not reach the dead-band, so the next one
// is compared with the last frame that was passed on.
class FrameLink final : public FrameReceiver {
 public:
  FrameLink(const FrameDeadBandSettings& settings, FrameReceiver& receiver, const Kernels& kernels)
      : sender_(settings, kernels), receiver_(receiver) {}

  void on_frame(const Frame& frame) override {
    if (sender_.sends(frame)) receiver_.on_frame(frame);
  }
  // See FrameSender.
  void observe_slave(const Vec3& slave_W, double time_s) { sender_.observe_slave(slave_W, time_s); }
  int sent() const { return sender_.sent(); }

 private:
  FrameSender sender_;
  FrameReceiver& receiver_;
};

}  // namespace remote_touch
