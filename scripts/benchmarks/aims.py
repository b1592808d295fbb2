"""What was asked of the times: aims of this project, and what a prototype reached (REACHABLE)."""

LEVELS = ["x86-64", "x86-64-v3", "x86-64-v4"]

# A proxy step in ns, from the published comparison; times as fast as the plain version.
ASKED_STEP_NS = {"x86-64-v3": 300, "x86-64-v4": 200}
ASKED_OF_NAIVE = 150
REACHABLE_QUERY_NS = 81
# Per point visited, a step among regions of 0.02 m as a multiple of one without a radius.
ASKED_OF_REGIONS = 1.5
ASKED_OF_PEERS = {"pcl_organized_neighbor": 4, "pcl_kdtree_flann": 20}

# s of the map of figure 4.13, by steps a frame and threads; times as fast as the plain version.
ASKED_MAP_S = {(30, 1): 6, (30, 2): 3.5, (1000, 2): 20}
ASKED_MAP_OF_PLAIN = 60
# ms of a lift of that map with 30 steps per tick: the mean over all noises; each noise by itself, in mm.
ASKED_LIFT_MEAN_MS = 1.8
ASKED_LIFT_MS = {0: None, 1: 3, 3: 3, 15: 3}

# us of a quadratic program of six variables, by rows: asked, and of the published prototype.
ASKED_PROGRAM_US = {6: 0.3, 50: 1.2}
REACHABLE_PROGRAM_US = {1: 0.06, 6: 0.20, 25: 0.64, 50: 0.97}

# us of the 6-DOF method: the collision list by level and scene, a step by points, both rules.
ASKED_LIST_US = {("2500_contact", "x86-64-v4"): 2.5, ("2500_contact", "x86-64"): 6,
                 ("2500_separated", "x86-64-v4"): 0.1, ("2500_separated", "x86-64"): 0.1}
ASKED_TOOL_STEP_US = {"voxels": {"2500": 4, "40000": 15}, "look-ahead": {"2500": 8, "40000": 15}}
ASKED_TOOL_TICK_MS = 0.3  # p99.9, while the tool slides
ASKED_TOOL_LANDING_MS = 0.4  # the tick of a new frame that has a surface in the tool
# How many times faster the collision list is than others.
ASKED_OF_TOOL_PEERS = {"bullet_gimpact_0.5mm": 100, "bullet_gimpact_2mm": 100, "fcl_octree_all": 200}

# A frame's tree of regions, and a tick of 112 leaves among them: mean and p99.9.
ASKED_REGION_TREE_MS = 2
ASKED_REGION_TICK_US = (100, 500)

# us of a frame of the tracked sheet, by noise in r_c; and its tick as a multiple of the proxy's.
ASKED_SHEET_FRAME_US = {"0": 300, "0.2": 300, "0.6": 300, "1": 300, "3": 600}
ASKED_SHEET_TICK = 1

ASKED_BAG_FRAMES_PER_S = 60
# us of a signed distance within 10 mm of the surface; ms of the depth image of 70 000 triangles, 640 x 480 pixels.
ASKED_MESH_DISTANCE_US = 2
ASKED_RASTER_MS = 10
# ms for filter and normals of a 640x480 frame, by threads and level; how many times faster than others; times FALS's
# time and of its error.
ASKED_DEPTH_MS = {(1, "x86-64-v4"): 12, (1, "x86-64-v3"): 22, (2, "x86-64-v4"): 6.5}
ASKED_OF_DEPTH_PEERS = {"pcl_covariance": 4, "pcl_normal_estimation_omp": 20}
ASKED_OF_FALS = {"opencv_fals_5": (4, 3), "opencv_fals_7": (4, 3)}
