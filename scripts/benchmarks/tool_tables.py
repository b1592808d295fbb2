"""Tables of six degrees of freedom on the terminal: the tool on points, sphere trees, collision detection of others."""
from benchmarks.aims import *
from benchmarks.printing import table

TOOL_SCENES = {"1089": "husky, 1089 points 3 mm apart", "111556_dense": "husky, 111556 points 0.3 mm apart",
               "111556_slab": "block of 40 x 40 x 20 mm, 111556 points 0.3 mm apart",
               "2500": "husky, 2500 points 2 mm apart", "40000": "husky, 40000 points 1 mm apart",
               "40000_dense": "husky, 40000 points 0.5 mm apart",
               "40000_slab": "block of 40 x 40 x 20 mm, 40000 points 0.5 mm apart"}
TOOL_PEERS = {"bullet_gimpact_0.5mm": "Bullet GImpact, triangles of 0.5 mm around the points",
              "bullet_gimpact_2mm": "Bullet GImpact, triangles of 2 mm around the points",
              "fcl_octree_all": "FCL, octree of 0.5 mm, all contacts",
              "fcl_octree_first": "FCL, octree of 0.5 mm, first contact",
              "voxmap_0.5mm": "voxmap and pointshell of 0.5 mm; contacts: points of the shell",
              "voxmap_2mm": "voxmap and pointshell of 2 mm, likewise"}
TOOL_POSES = {"contact": "in contact", "pressed": "2 mm deeper"}


def print_tool(times):
    rows = []
    for name, ns in times.ns.items():
        kind, _, rest = name.partition("/")
        scene, _, level = rest.partition("/")
        if kind != "tool_list":
            continue
        asked = ASKED_LIST_US.get((scene, level))
        naive = times.ns.get(f"tool_list_naive/{scene}")
        points, _, where = scene.rpartition("_")
        rows.append([f"{TOOL_SCENES[points]}, {where}, {level}", f"{times.counters[name]['found']:.0f}", asked or "",
                     f"{ns / 1000:.3f}", f"{ns / 1000 / asked:.2f}" if asked else "",
                     f"{naive / ns:.0f}" if naive else "-"])
    table("Collision list of a tool, us; naive: a lookup for every point",
          ["", "found", "asked <=", "measured", "ratio", "x naive"], rows)
    steps, ticks = [], []
    for name, ns in times.ns.items():
        kind, _, rest = name.partition("/")
        scene, _, level = rest.partition("/")
        points, _, rule = scene.rpartition("_")
        counters = times.counters[name]
        if kind == "tool_step":
            asked = ASKED_TOOL_STEP_US[rule].get(points)
            steps.append([f"{TOOL_SCENES[points]}, {rule}, {level}", f"{counters['listed']:.0f}", asked or "",
                          f"{ns / 1000:.2f}", f"{ns / 1000 / asked:.2f}" if asked else ""])
        elif kind == "tool_tick":
            ticks.append([f"{TOOL_SCENES[points]}, {rule}, {level}", f"{counters['detections']:.1f}",
                          f"{ns / 1000:.0f}", f"{1000 * ASKED_TOOL_TICK_MS:.0f}" if rule != "voxels" else "",
                          f"{counters['p99_9_ns'] / 1000:.0f}", f"{counters['max_ns'] / 1000:.0f}"])
    table("One 6-DOF step: detection, program and motion, us",
          ["", "contacts", "asked <=", "measured", "ratio"], steps)
    table("Whole ticks of the tool, sliding at 0.1 m/s, us; of every tick the least CPU time among the slides",
          ["", "detections", "mean", "asked <=", "p99.9", "largest"], ticks)


def print_spheres(times):
    rows = []
    for name, ns in times.ns.items():
        kind, _, rest = name.partition("/")
        where, _, level = rest.partition("/")
        if kind == "region_tree":
            counters = times.counters[name]
            print(f"\nTree of the regions of a frame of 640 x 480, {counters['leaves']:.0f} leaves in "
                  f"{counters['patches']:.0f} patches: {ns / 1e6:.2f} ms (asked <= {ASKED_REGION_TREE_MS:g})")
        elif kind == "region_contacts":
            counters, naive = times.counters[name], times.ns.get(f"region_contacts_naive/{where}")
            rows.append([f"{where}, {level}", f"{counters['pairs']:.0f}", f"{counters['contacts']:.0f}",
                         f"{ns / 1000:.2f}", f"{naive / ns:.1f}" if naive else "-"])
    table("Contacts of 112 leaves with regions, us; naive: every pair of leaves",
          ["", "pairs", "contacts", "measured", "x naive"], rows)
    rows = []
    for name in times.ns:
        kind, _, rest = name.partition("/")
        if kind != "region_tick":
            continue
        what, _, level = rest.partition("/")
        tool, leaves, course = what.split("_")
        counters = times.counters[name]
        mean, slow = counters["mean_ns"] / 1000, counters["p99_9_ns"] / 1000
        asked = leaves == "112"
        rows.append([f"{tool}, {leaves} leaves, {course}, {level}", f"{counters['detections']:.1f}",
                     f"{counters['max_detections']:.0f}", ASKED_REGION_TICK_US[0] if asked else "", f"{mean:.0f}",
                     ASKED_REGION_TICK_US[1] if asked else "", f"{slow:.0f}", f"{counters['max_ns'] / 1000:.0f}"])
    table("Whole ticks among regions, us, of every tick the least CPU time; swallowed: every other frame is 30 mm nearer",
          ["", "detections", "most", "asked <=", "mean", "asked <=", "p99.9", "largest"], rows)


def print_tool_peers(peers):
    rows = []
    for name, ns in peers.ns.items():
        _, where, peer = name.split("/", 2)
        asked, times_ours, what = "", [""] * len(LEVELS), peer.replace("/", ", ")
        if not peer.startswith("ours"):
            ours = [peers.ns.get(f"list/{where}/ours/{level}") for level in LEVELS]
            asked, what = ASKED_OF_TOOL_PEERS.get(peer, ""), TOOL_PEERS[peer]
            times_ours = [f"{ns / each:.1f}" if each else "-" for each in ours]
        counters = peers.counters[name]
        rows.append([f"{what}, {TOOL_POSES[where]}", f"{counters['found']:.0f}",
                     f"{counters['contacts']:.0f}" if "contacts" in counters else "", asked, *times_ours,
                     f"{ns / 1000:.2f}"])
    table("Collision list against others, husky, 2500 points 2 mm apart: how many times ours they take",
          ["", "points found", "contacts", "asked x >=", *[f"x {level}" for level in LEVELS], "us"], rows)
