// Experiments as text: a small one, one with a task, and one with every section.
#pragma once

namespace remote_touch {

inline constexpr const char* kSmall = R"({"seed": 5, "scenario": {"name": "flat-grid", "columns": 7},
    "renderer": {"name": "proxy", "xi": 0.25}, "trajectory": {"name": "waypoints"}})";

inline constexpr const char* kTask = R"({"scenario": {"name": "flat-grid"},
    "fixtures": [{"name": "everywhere", "label": "table"},
                 {"name": "half-space", "role": "guidance", "label": "valve", "radius_m": 0.01}],
    "guidance": {"standoff_m": 0.05, "orientation": "plane"},
    "sequence": [{"action": "lock", "fixture": "table", "not_before_s": 0.1},
                 {"action": "activate", "fixture": "valve", "start": "button", "button": 2, "done": "reached",
                  "deadline_s": 4, "offset_m": [0, 0.1, 0]},
                 {"action": "wait", "done": "button", "button": 2}],
    "renderer": {"name": "proxy"}, "trajectory": {"name": "waypoints"},
    "operator": {"mass_kg": 0.7, "grip": [[0, 1], [2, 0]], "presses": [[1, 2, 0.1]]},
    "device": {"torque_x": false, "max_force_N": 8}})";

inline constexpr const char* kAll = R"({"scenario": {"name": "camera-scene"}, "faults": {},
    "depth_pipeline": {},
    "fixtures": [{"name": "everywhere", "role": "guidance", "label": "all", "radius_m": 0.01}],
    "guidance": {}, "sequence": [{"action": "activate", "fixture": "all"}], "renderer": {"name": "proxy"},
    "changes": [{"time_s": 1, "parameter": "renderer.r3_m", "value": 0.02}],
    "trajectory": {"name": "waypoints"}, "operator": {}, "device": {}, "slave": {}, "command_link": {},
    "force_link": {}, "frame_link": {}, "feedback": {}, "registration": {}, "live": {}, "safety": {}})";

}  // namespace remote_touch
