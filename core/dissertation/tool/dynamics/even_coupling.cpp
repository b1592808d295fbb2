#include "core/dissertation/tool/dynamics/even_coupling.h"

namespace remote_touch {

Parameters parameters(EvenCoupling& p) {
  return {
      {"stiffness_N_per_m", &p.stiffness_N_per_m, 1, 10000, "stiffness of the virtual coupling"},
      {"gyration_radius_m", &p.gyration_radius_m, 1e-3, 1,
       "rotational stiffness = stiffness times this squared"},
      {"max_force_N", &p.max_force_N, 0, 1000,
       "maximum magnitude of the force; larger forces are scaled down to it"},
      {"max_torque_Nm", &p.max_torque_Nm, 0, 100,
       "maximum magnitude of the torque; larger torques are scaled down to it"},
  };
}

ToolParameters tool_parameters(const EvenCoupling& p) {
  ToolParameters tool;
  tool.stiffness_N_per_m = p.stiffness_N_per_m, tool.gyration_radius_m = p.gyration_radius_m;
  tool.merged_disk_m = 0;  // none of these methods merges disks
  tool.max_force_N = p.max_force_N, tool.max_torque_Nm = p.max_torque_Nm;
  return tool;
}

}  // namespace remote_touch
