"""All quantities that are stored, in the order of the pages. A new one is one line here; its key never changes its meaning."""
from benchmarks.aims import *
from benchmarks.quantity import (TIME_UNITS, TIMES, Quantity, counter, cpu, entry, extreme, least, most, over, scaled,
                                 two_threads_wall, wall)


# --- proxy ---

def proxy_quantities():
    part, table = "proxy", "proxy"
    step, tick = cpu("step_with_kept_list/grid/{level}"), cpu("tick/grid/{level}")
    yield Quantity("proxy_step/{level}", part, table, "proxy step with its search, 105 points, double", "ns", step,
                   most(ASKED_STEP_NS), over(cpu("step_naive/grid"), step),
                   "the same written plainly over all 100 x 100 points: times as long",
                   least({level: ASKED_OF_NAIVE for level in ASKED_STEP_NS}))
    yield Quantity("proxy_step_gathered/{level}", part, table, "proxy step, points gathered anew for every step",
                   "ns", cpu("step_with_search/grid/{level}"))
    yield Quantity("proxy_tick/{level}", part, table, "tick in contact, 30 steps of gamma 0.3", "us", tick)
    for steps, gamma in ((10, "0.3"), (8, "0.5")):
        fewer = cpu(f"tick_of_{steps}_steps/grid/{{level}}")
        yield Quantity(f"proxy_tick_{steps}_steps/{{level}}", part, table, f"tick in contact, {steps} steps of gamma {gamma}",
                       "us", fewer, None, over(fewer, tick), f"{steps} steps of gamma {gamma}, relative to 30 steps of gamma 0.3")
    yield Quantity("radius_query/{level}", part, table, "radius query of 81 points in a 640 x 480 image", "ns",
                   cpu("query_window/image_1.03m_slide/{level}"))
    contact, plain = (f"fixture_contact/{regions}/{{level}}" for regions in ("all", "none"))

    def per_point(name):
        return over(cpu(name), counter(name, "listed"))
    yield Quantity("regions_step/{level}", part, table,
                   "proxy step in contact, 640 x 480 points, all r_f = 0.02 m: 1085 points", "us", cpu(contact), None,
                   over(per_point(contact), per_point(plain)),
                   "the same per point, relative to a cloud without regions", most(ASKED_OF_REGIONS))
    yield Quantity("regions_tick/{level}", part, table, "tick of 30 such steps among regions", "us", cpu("fixture_tick/all/{level}"))
    for choose, which in ((min, "quickest"), (max, "slowest")):
        yield Quantity(f"fixture_rule_{which}", part, table, f"{which} fixture rule, per frame of 640 x 480 points", "ms",
                       extreme(choose, "fixture_assign/"))
    number = scaled(counter("normals/{level}", "s_per_normal"), 1e9)
    yield Quantity("normal_number/{level}", part, table, "normally distributed random number", "ns", number, None,
                   over(scaled(counter("normals_standard_library", "s_per_normal"), 1e9), number),
                   "the same by the standard library: times as long")
    for rows in (6, 50):
        program = cpu(f"program_ours/{rows}")
        yield Quantity(f"quadratic_program_{rows}", part, "tool", f"quadratic program of 6 variables, {rows} rows", "us",
                       program, most(ASKED_PROGRAM_US[rows]), over(cpu(f"program_nlopt/{rows}"), program),
                       "the same by NLopt's SLSQP: times as long")


def map_quantities():
    part, table = "map", "map"
    own = cpu("map/30/1/{level}")
    yield Quantity("map_30_steps/{level}", part, table, "map of 5396 lifts, 30 steps per frame, one core", "s", own,
                   most(ASKED_MAP_S[30, 1]), over(cpu("plain/30/1/{level}"), own),
                   "the same written plainly with all noise made by the standard library: times as long",
                   least(ASKED_MAP_OF_PLAIN))
    for steps in (30, 1000):
        yield Quantity(f"map_{steps}_steps_two_cores/{{level}}", part, table,
                       f"map of 5396 lifts, {steps} steps per frame, two cores, wall-clock time", "s",
                       wall(f"map/{steps}/2/{{level}}"), most(ASKED_MAP_S[steps, 2]))
    yield Quantity("lift_mean/{level}", part, table, "lift with six measures, 30 steps per tick, mean over the map", "ms",
                   scaled(cpu("map/1000/1/{level}"), 1 / 5396), most(ASKED_LIFT_MEAN_MS))
    for noise_mm, aim in ASKED_LIFT_MS.items():
        yield Quantity(f"lift_{noise_mm}_mm/{{level}}", part, table, f"lift with six measures, noise of {noise_mm} mm", "ms",
                       cpu(f"lift/{noise_mm}/{{level}}"), aim and most(aim))


def sheet_quantities():
    part, table = "sheet", "sheet"
    for noise in ("0", "0.2", "0.6", "1", "2", "3"):
        aim = ASKED_SHEET_FRAME_US.get(noise)
        yield Quantity(f"sheet_frame/{noise}/{{level}}", part, table, f"frame, noise of {noise} r_c", "us",
                       counter(f"sheet_lift/tracked-sheet/{noise}/{{level}}", "frame_ns"), aim and most(aim))
    for noise in ("0", "0.2", "0.6", "1", "2", "3"):
        own, proxy = (counter(f"sheet_lift/{method}/{noise}/{{level}}", "tick_ns") for method in ("tracked-sheet", "proxy"))
        yield Quantity(f"sheet_tick/{noise}/{{level}}", part, table, f"tick while the HIP presses, noise of {noise} r_c", "us",
                       own, None, over(own, proxy), "the same relative to a tick of the proxy", most(ASKED_SHEET_TICK))


# --- tool, sphere trees ---

TOOL_CLOUDS = {"1089": "dog, 1089 points, 3 mm", "2500": "dog, 2500 points, 2 mm", "40000": "dog, 40 000 points, 1 mm",
               "40000_dense": "dog, 40 000 points, 0.5 mm", "111556_dense": "dog, 111 556 points, 0.3 mm",
               "40000_slab": "flat block, 40 000 points, 0.5 mm", "111556_slab": "flat block, 111 556 points, 0.3 mm"}
CONTINUOUS_CLOUDS = ("2500", "40000", "111556_dense")


def tool_quantities():
    part = "tool"
    for where, key, text in (("contact", "tool_list", "collision list, 2500 points"),
                             ("separated", "tool_list_clear", "collision list, 2500 points, tool clear of them")):
        name, aims = f"tool_list/2500_{where}/{{level}}", {level: ASKED_LIST_US[each, level] for each, level in ASKED_LIST_US
                                                           if each == f"2500_{where}"}
        yield Quantity(f"{key}/{{level}}", part, "tool", text, "us", cpu(name), most(aims),
                       over(cpu(f"tool_list_naive/2500_{where}"), cpu(name)), "the same written plainly: times as long")
    for points in ("2500", "40000"):
        yield Quantity(f"tool_step_voxels/{points}/{{level}}", part, "tool", f"step of the printed rule, {points} points",
                       "us", cpu(f"tool_step/{points}_voxels/{{level}}"), most(ASKED_TOOL_STEP_US["voxels"][points]))
    for cloud, text in TOOL_CLOUDS.items():
        aim = ASKED_TOOL_STEP_US["look-ahead"].get(cloud)
        yield Quantity(f"tool_step_look_ahead/{cloud}/{{level}}", part, "tool_ticks", f"look-ahead step: {text}", "us",
                       cpu(f"tool_step/{cloud}_look-ahead/{{level}}"), aim and most(aim))
    for rule, clouds in (("look-ahead", TOOL_CLOUDS), ("continuous", CONTINUOUS_CLOUDS)):
        yield from tick_quantities(part, rule, clouds)


def tick_quantities(part, rule, clouds):
    key = rule.replace("-", "_")
    for cloud in clouds:
        name, text = f"{cloud}_{rule}/{{level}}", TOOL_CLOUDS[cloud]
        if rule == "look-ahead":
            yield Quantity(f"tool_tick_{key}_mean/{cloud}/{{level}}", part, "tool_ticks", f"{rule} tick, mean: {text}",
                           "ms", cpu(f"tool_tick/{name}"))
        yield Quantity(f"tool_tick_{key}/{cloud}/{{level}}", part, "tool_ticks", f"{rule} tick, p99.9: {text}", "ms",
                       counter(f"tool_tick/{name}", "p99_9_ns"), most(ASKED_TOOL_TICK_MS))
    for cloud in clouds:
        yield Quantity(f"tool_landing_{key}/{cloud}/{{level}}", part, "tool_ticks",
                       f"{rule} tick of a frame that lands in the tool: {TOOL_CLOUDS[cloud]}", "ms",
                       counter(f"tool_landing/{cloud}_{rule}/{{level}}", "landing_ns"), most(ASKED_TOOL_LANDING_MS))


def sphere_quantities():
    part, table = "spheres", "spheres"
    yield Quantity("region_tree", part, table, "tree of 3714 regions of a 640 x 480 frame", "ms", cpu("region_tree/wheels"),
                   most(ASKED_REGION_TREE_MS))
    for where, text in (("clear", "tool clear of the regions"), ("touching", "touching"), ("deep", "30 mm deep")):
        own = cpu(f"region_contacts/{where}/{{level}}")
        yield Quantity(f"region_contacts/{where}/{{level}}", part, table, f"detection, 112 leaves, {text}", "us", own, None,
                       over(cpu(f"region_contacts_naive/{where}"), own), "the same, every pair of leaves: times as long")
    for course, text in (("slide", "slide around the valves"),
                         ("swallowed", "regions 30 mm nearer in every other frame")):
        for tool in ("key", "husky"):
            for what, value, aim in zip(("mean", "p99.9"), ("mean_ns", "p99_9_ns"), ASKED_REGION_TICK_US):
                yield Quantity(f"region_tick_{what}/{tool}_{course}/{{level}}", part, table,
                               f"tick, {what}, `{tool}`, {text}", "us",
                               counter(f"region_tick/{tool}_112_{course}/{{level}}", value), most(aim))


# --- depth, meshes, bags ---

def depth_quantities():
    part, table = "depth", "depth"
    own = cpu("depth_frame/1/{level}")
    aims = [{level: ASKED_DEPTH_MS[each] for each in ASKED_DEPTH_MS for level in each[1:] if each[0] == n} for n in (1, 2)]
    yield Quantity("depth_frame/{level}", part, table, "filter and normals, 640 x 480 pixels, one core", "ms", own,
                   most(aims[0]), over(cpu("depth_plain"), own), "the same written plainly in double: times as long")
    yield Quantity("depth_frame_two_cores/{level}", part, table,
                   "filter and normals, 640 x 480 pixels, two cores, wall-clock time", "ms",
                   two_threads_wall("depth_frame/2/{level}"), most(aims[1]))
    yield Quantity("depth_region/{level}", part, table, "filter and normals of a region of 2500 points, one core", "us",
                   cpu("depth_region/1/{level}"))


def mesh_quantities():
    part, table = "meshes", "meshes"
    meshes = {"ball_15000": "a wavy ball, 15 000 triangles", "ball_70000": "a wavy ball, 70 000 triangles",
              "dragon_14897": "the dragon of `visp_cube_dragon`, 15 000 triangles", "hand_15982": "a hand, 15 982 triangles",
              "drill_15728": "a power drill, 15 728 triangles"}
    for mesh, text in meshes.items():
        key, own = mesh.split("_")[0] if "ball" not in mesh else mesh, cpu(f"mesh_distance/{mesh}")
        yield Quantity(f"mesh_distance/{key}", part, table, f"signed distance to {text}", "us", own,
                       most(ASKED_MESH_DISTANCE_US), over(cpu(f"mesh_distance_plain/{mesh}"), own),
                       "the same by a loop over all triangles: times as long")
        yield Quantity(f"mesh_distance_discs/{key}", part, table,
                       f"{text}: by a tree of discs, without a sign, times as long", TIMES, over(cpu(f"mesh_distance_by_discs/{mesh}"), own))
        yield Quantity(f"mesh_distance_build/{key}", part, table, f"{text}: construction", "ms", cpu(f"mesh_distance_build/{mesh}"))
    for scene, text in (("ball", "ball of 70 056 triangles that covers a quarter"),
                        ("ball_and_table", "that ball above a table")):
        yield Quantity(f"raster/{scene}", part, table, f"depth image, 640 x 480 pixels: {text}", "ms",
                       cpu(f"raster/{scene}"), most(ASKED_RASTER_MS))


def bag_quantities():
    for bag, text in (("plain.mcap", "`.mcap` without compression"), ("lz4.mcap", "`.mcap` with LZ4"),
                      ("zstd.mcap", "`.mcap` with Zstandard"), ("sqlite.db3", "`.db3`")):
        def frames_per_s(times, _, name=f"bag_cloud/{bag}"):
            return 1e9 / times.ns[name] if name in times.ns else None
        yield Quantity(f"bag/{bag}", "bags", "bags", text, "frames/s", frames_per_s, least(ASKED_BAG_FRAMES_PER_S))


# --- other libraries, with --peers ---

def peer_quantities():
    for peer, key, text in (("pcl_organized_neighbor", "pcl_organized", "PCL's OrganizedNeighbor"),
                            ("pcl_kdtree_flann", "pcl_kdtree", "PCL's k-d tree")):
        yield Quantity(f"radius_query_{key}/{{level}}", "search_peers", "peers", f"radius query of 81 points by {text}", TIMES,
                       over(cpu(f"query/image_1.03m_slide/{peer}"), cpu("query/image_1.03m_slide/ours/{level}")),
                       least(ASKED_OF_PEERS[peer]))
    for peer, text, aim in (("pcl_covariance", "PCL's covariance integral image", ASKED_OF_DEPTH_PEERS["pcl_covariance"]),
                            ("pcl_normal_estimation_omp", "PCL's NormalEstimationOMP",
                             ASKED_OF_DEPTH_PEERS["pcl_normal_estimation_omp"]),
                            ("opencv_fals_5", "OpenCV's FALS, window 5", 1 / ASKED_OF_FALS["opencv_fals_5"][0]),
                            ("opencv_fals_7", "OpenCV's FALS, window 7", 1 / ASKED_OF_FALS["opencv_fals_7"][0])):
        yield Quantity(f"normals_{peer}/{{level}}", "depth_peers", "peers",
                       f"normals by {text}, relative to filter and normals of this project", TIMES,
                       over(cpu(f"raw/{peer}"), cpu("both/ours/{level}")), least(aim))
    for where, pose in (("contact", "tool touches"), ("pressed", "2 mm deeper")):
        for peer, text in (("fcl_octree_all", "FCL's octree, all contacts"),
                           ("bullet_gimpact_0.5mm", "Bullet's GImpact, triangles of 0.5 mm"),
                           ("bullet_gimpact_2mm", "Bullet's GImpact, triangles of 2 mm")):
            yield Quantity(f"tool_list_{peer}/{where}/{{level}}", "tool_peers", "peers",
                           f"collision list of 2500 points by {text}, {pose}", TIMES,
                           over(cpu(f"list/{where}/{peer}"), cpu(f"list/{where}/ours/{{level}}")),
                           least(ASKED_OF_TOOL_PEERS[peer]))


PARTS = ("proxy", "map", "sheet", "spheres", "tool", "depth", "meshes", "bags", "search_peers", "depth_peers", "tool_peers")
TABLES = ("proxy", "map", "tool", "tool_ticks", "depth", "peers", "spheres", "sheet", "meshes", "bags")
QUANTITIES = [*tool_quantities(), *proxy_quantities(), *map_quantities(), *depth_quantities(), *sphere_quantities(),
              *sheet_quantities(), *mesh_quantities(), *bag_quantities(), *peer_quantities()]


def entries_of(part, times):
    """{key: entry} of all quantities of the part that the times have; values with three digits."""
    entries = {}
    for quantity in QUANTITIES:
        if quantity.part != part:
            continue
        for level in quantity.levels():
            value = quantity.value(times, level) if quantity.value else None
            ratio = quantity.ratio(times, level) if quantity.ratio else None
            if value is not None:
                entries[quantity.key_at(level)] = entry(quantity, level, value / TIME_UNITS.get(quantity.unit, 1), ratio)
    return entries
