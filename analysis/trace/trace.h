// The trace of a run: its columns, the log of a task, and the states of hand and slave in a tick.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "analysis/trace/columns.h"
#include "core/points/vector.h"
#include "core/rendering/frames_and_outputs.h"

namespace remote_touch {

struct Trace;

// A step that has begun. Its times are times of ticks. ended_s is NaN if the step had not ended at the end of
// the trace.
struct SequenceEntry {
  int step = 0;  // its number in the task
  double began_s = 0;
  double ended_s = std::numeric_limits<double>::quiet_NaN();
  bool missed = false;  // true if the deadline ended the step
  // Distance and angle from the tool to the step's goal when the step ended; NaN for a step without a goal.
  // All steps that ended in the same tick have the values of the first of them with a goal.
  double distance_m = std::numeric_limits<double>::quiet_NaN();
  double angle_rad = std::numeric_limits<double>::quiet_NaN();
};

// Returns the entries in the order of the steps; empty for a trace without a task.
std::vector<SequenceEntry> sequence_log(const Trace& trace);

// The state of a simulated hand: its intended pose, and the force and torque that it felt.
struct HandState {
  struct Pose {
    Vec3 position_W = Vec3::Zero();
    Eigen::Quaterniond orientation_W = Eigen::Quaterniond::Identity();
  };
  Vec3 intended_W = Vec3::Zero();
  Eigen::Quaterniond intended_orientation_W = Eigen::Quaterniond::Identity();
  Vec3 force_N = Vec3::Zero(), torque_Nm = Vec3::Zero();  // exerted by the device on the hand
  // The pose of the hand. Present if the device rounds it; otherwise it is the pose that the device measures.
  std::optional<Pose> true_pose = {};
};

// The orientation and the contact of a slave's tool, world frame.
struct SlaveToolState {
  Eigen::Quaterniond orientation_W{Eigen::Vector4d::Constant(std::numeric_limits<double>::quiet_NaN())};
  // Mean torque of the scene about the centre of mass in the last tick.
  Vec3 torque_Nm = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
};

// Energies of the channel between hand and slave since the start of a run, J. None of them falls. in - out of
// both ends is the energy in the channel; it is negative if the channel has given more than it received.
struct ChannelEnergy {
  double hand_in_J = 0, hand_out_J = 0;    // entered and left at the hand
  double slave_in_J = 0, slave_out_J = 0;  // entered and left at the slave
  double dissipated_J = 0;                 // kept from leaving by passivity control, not part of the balance
};

// The slave of a run with teleoperation, world frame, and the packets that were sent to it and by it.
struct SlaveState {
  Vec3 command_W = Vec3::Zero();   // position to which the command that it has received last sends it
  Vec3 position_W = Vec3::Zero();  // centre of its ball, or centre of mass of its tool
  Vec3 force_N = Vec3::Zero();     // mean force of the scene on it in the last tick
  double peak_force_N = 0;         // largest magnitude of that force in the last tick
  double clearance_m = 0;          // distance of ball or tool from the true surface, negative behind it
  // Packets so far: commands and forces that were sent, and frames that have arrived.
  std::int32_t command_packets = 0, force_packets = 0, frame_packets = 0;
  std::optional<ChannelEnergy> energy;  // present in all ticks of a run whose hand is to feel the slave
  std::optional<SlaveToolState> tool;   // present in all ticks of a run whose slave has a tool
};

// The record of a run: one row for each haptic tick, in the columns of trace_columns.h.
struct Trace {
  std::size_t length() const { return time_s.size(); }
  void reserve(std::size_t ticks);
  // Signed distances of the renderer's contact point and of the HIP from the true surface: positive above it,
  // NaN if the truth is not known.
  struct TrueContact {
    double height_m = 0;        // height of the contact point
    double hip_distance_m = 0;  // distance of the HIP
    // Height of the contact point above the surface that a real camera measured. NaN if the run has none
    // beside its true one, or if it is not known there.
    double measured_height_m = std::numeric_limits<double>::quiet_NaN();
  };
  // Ground truth of a tick, which the renderer does not know.
  struct Truth {
    double proxy_distance_m = 0;              // distance of the proxy from the true surface
    double slave_distance_m = 0;              // distance of the slave's command from it
    std::uint64_t frame_hash = 0;             // hash of the newest frame delivered; 0 if it was not computed
    std::optional<TrueContact> contact = {};  // computed only if a measure needs it
    // Unit normal of the true surface at the renderer's contact, towards the free side. NaN if it is not
    // known or nothing is touched. Computed only if a measure needs it.
    std::optional<Vec3> normal = {};
    // The force that Trajectory::expected_force_N() states. Present in every tick of a run or in none.
    std::optional<Vec3> expected_force_N = {};
    // Distance of the proxy from the surface that a real camera measured, Scenario::measured_distance().
    // Present in every tick of a run or in none.
    std::optional<double> measured_distance_m = {};
  };
  void append(double time, const DeviceState& device, const RenderOutput& out, const Truth& truth,
              const std::optional<HandState>& hand = {}, const std::optional<SlaveState>& slave = {});

  bool has_tool() const { return !tool_orientation.empty(); }
  bool has_guidance() const { return !guidance_goal_m.empty(); }
  bool has_hand() const { return !intended_position_m.empty(); }
  bool has_rounded_hand() const { return !hand_position_m.empty(); }
  bool has_slave() const { return !slave_position_m.empty(); }
  bool has_channel_energy() const { return !hand_energy_in_J.empty(); }
  bool has_slave_tool() const { return !slave_orientation.empty(); }
  bool has_replay() const { return !expected_force_N.empty(); }
  bool has_measured_surface() const { return !measured_distance_m.empty(); }
  bool has_contact() const { return !contact.empty(); }
  bool has_true_normal() const { return !true_normal.empty(); }
  // True if tick i uses another frame than tick i - 1; false for the first tick.
  bool frame_update(std::size_t i) const { return i > 0 && frame_index[i] != frame_index[i - 1]; }

  // Copies of the columns, with units, in the order in which they are stored and hashed; the last is the
  // running hash of the others.
  std::vector<Column> columns() const;

  // The rows: a vector for each column.
#define TRACE_COLUMN(member, Row, ...) std::vector<Row> member;
#include "analysis/trace/trace_columns.h"
#undef TRACE_COLUMN

  // Depth behind the true surface, m, down to which the proxy still counts as held by the surface. 0 for a
  // ball, whose centre stays in front. See held_depth_m() in frames_and_outputs.h. Only measures use it, so
  // it is not a column.
  double held_depth_m = 0;
  // Rows that only measures use. They are not stored as columns. Empty unless they were computed.
  std::vector<TrueContact> contact;
  std::vector<Vec3> true_normal;  // Truth::normal
};

// The runs that have a column: all, those with a 6-DOF tool, those with guidance or a sequence, those with a
// simulated operator or device, those that replay a contact whose force is known, those with a measured
// surface beside the true one, those whose device rounds the pose of the hand, those with a slave, those
// whose hand is to feel the slave, those whose slave has a tool.
enum class TracePart {
  always,
  tool,
  guidance,
  hand,
  replay,
  measured_surface,
  rounded_hand,
  slave,
  channel_energy,
  slave_tool
};

struct TraceColumn {
  const char* name;
  const char* unit;
  const char* meaning;
  const char* meaning_with_tool;  // used in a run with a tool
  TracePart part;
  int width;  // numbers in a row
  std::vector<std::string> value_names;
  Values (*values)(const Trace&);  // null for the running hash, which is made of all columns before it
};

// Every column that a trace can have, in order.
const std::vector<TraceColumn>& trace_columns();

// Builds a trace from stored columns, which it requests by name one after the other. `contact` and
// `true_normal` stay empty, because they are not stored as columns. Returns std::nullopt if a column that
// such a run has is missing, or if a column has a wrong type, width or length.
std::optional<Trace> trace_of(const std::function<std::optional<Column>(const std::string&)>& column);

}  // namespace remote_touch
