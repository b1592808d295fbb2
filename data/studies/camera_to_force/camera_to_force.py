"""From the camera to the force: one run, from the depth image to what the hand feels. README.md beside this file tells it."""
import sys

import numpy as np

import remote_touch as rt
from remote_touch.studies import color_map, dashed, dots, line, main, study

RC_M, REGION_M = 0.005, 0.015
GROWS_S = (2.0, 2.5)  # the forbidden region
EXPERIMENT = {
    "title": "a beating heart is touched, then a region grows around it",
    "scenario": {"name": "beating-heart"},
    "fixtures": [{"name": "everywhere", "radius_m": REGION_M, "schedule": [[GROWS_S[0], 0], [GROWS_S[1], 1]]}],
    "renderer": {"name": "proxy", "exit_rule": "out-of-contact", "xi": 1 / 3, "theta_deg": 1},
    "trajectory": {"name": "waypoints", "waypoints": [[0.008, 0.09, 0.006, 0], [0.008, 0.05, 0.006, 0.1]]},
    "duration_s": 4,
}
ROWS, COLUMNS, EVERY = slice(165, 325), slice(220, 420), 2  # of the image: what panels show
FRAME, FRAME_S = 22, 22 / 30  # the heart is high


def seen(config):
    """A frame, and what a camera without errors sees at that time."""
    scene = dict(config["scenario"])
    name, key = scene.pop("name"), rt.NoiseKey(seed=config["seed"])
    exact = scene | {"noise_per_m": 0, "quantisation_per_m": 0, "hole_px": 0}
    return [rt.scene(name, key=key, **settings).cloud(FRAME) for settings in (scene, exact)]


def add_image(s, cloud):
    depth_m = cloud.depth[ROWS, COLUMNS][::EVERY, ::EVERY]
    rows, columns = np.mgrid[ROWS.start:ROWS.stop:EVERY, COLUMNS.start:COLUMNS.stop:EVERY]
    s.table("image", "depths that the camera measures", column=(columns.ravel(), "px", "column of the image"),
            row=(-rows.ravel(), "px", "row of the image, downwards"), depth=(depth_m.ravel(), "m", "depth along the optical axis"))
    s.panel("The camera measures depths", "column (px)", "row (px)", [color_map("image", "column", "row", "depth", z="depth")])


def add_profile(s, cloud, exact):
    row = cloud.depth.shape[0] // 2
    at = np.arange(COLUMNS.start, COLUMNS.stop)
    camera = cloud.camera
    x_m = (at - camera["cx"]) / camera["fx"]  # times the depth
    height_m = cloud.camera_pose[1, 3]
    measured_m, true_m = cloud.depth[row, at], exact.depth[row, at]
    s.table("profile", "the middle row: measured and true heights", x=(x_m * measured_m, "m", "along x"),
            measured=(height_m - measured_m, "m", "measured height"))
    s.table("true_profile", "the middle row as a camera without errors sees it", x=(x_m * true_m, "m", "along x"),
            height=(height_m - true_m, "m", "true height"))
    s.panel("One row of it: noise, steps, holes", "x (m)", "height (m)",
            [dots("profile", "x", "measured", "measured"), line("true_profile", "x", "height", "true surface")])
    return measured_m - true_m


def add_points(s, cloud, run):
    near = np.nonzero(np.hypot(cloud.x - 0.008, cloud.z - 0.006) < 0.06)[0][::2]
    place_m = run.proxy_position[np.searchsorted(run.time, FRAME_S) + 10]
    axes = dict(zip("xyz", cloud.points[near].T))
    s.table("points", "points of a frame, near the hand", {axis: (values, "m", axis) for axis, values in axes.items()})
    s.table("proxy", "the proxy on them", {axis: ([value], "m", axis) for axis, value in zip("xyz", place_m)})
    parts = (("points", 0x8CAFD8, 0.0012, "points"), ("proxy", 0x146BAB, 2 * RC_M, "proxy"))
    s.panel("The points and the proxy", "", "", [], scene={
        "eye": (0.3, 0.22, 0.3), "target": (0.008, 0.04, 0.006), "up": (0, 1, 0), "width_m": 0.15, "height_per_width": 0.62,
        "parts": [{"kind": "points", "table": table, "colour": colour, "size_m": size_m, "label": label}
                  for table, colour, size_m, label in parts]})


def add_run(s, run):
    region_m = RC_M + REGION_M * ((run.time - GROWS_S[0]) / (GROWS_S[1] - GROWS_S[0])).clip(0, 1)
    s.table("run", "the run", time=(run.time, "s", "simulated time"), hip=(run.hip_position[:, 1], "m", "height of the HIP"),
            proxy=(run.proxy_position[:, 1], "m", "height of the proxy"), force=(run.norm("force"), "N", "norm of the force"),
            distance=(run.signed_distance, "m", "from the proxy to the true surface"), region=(region_m, "m", "r_f + r_c"))
    s.panel("The proxy stays on the surface", "time (s)", "height (m)",
            [line("run", "time", "proxy", "proxy"), dashed("run", "time", "hip", "HIP")])
    s.panel("A region keeps it away", "time (s)", "distance to the true surface (m)",
            [line("run", "time", "distance", "proxy"), dashed("run", "time", "region", "r_f + r_c")], y_range=(0, 0.03))
    s.panel("The force on the hand", "time (s)", "force (N)", [line("run", "time", "force", "force")])
    return region_m


@study("camera-to-force", "one run, from the depth image to the force", title="From the camera to the force",
       caption="A simulated camera looks down on a beating heart; the proxy follows the measured surface, and from 2 s on a "
               "forbidden region grows around it.")
def camera_to_force(s):
    run, config = s.run(EXPERIMENT), s.uses(EXPERIMENT)
    cloud, exact = seen(config)
    add_image(s, cloud)
    error_m = add_profile(s, cloud, exact)
    add_points(s, cloud, run)
    region_m = add_run(s, run)
    s.place_in_rows(2)
    settled = (run.time > 0.5) & ((run.time < GROWS_S[0]) | (run.time > GROWS_S[1] + 0.1))
    claims = s.claims()
    claims.at_most("the camera's errors are small where it measures a depth: median of their norms", np.nanmedian(abs(error_m)), 0.001, "m")
    claims.at_most("the proxy keeps its distance from the true surface: rms difference from r_f + r_c",
                   np.sqrt(np.mean((run.signed_distance - region_m)[settled] ** 2)), 0.003, "m")
    claims.at_least("the hand feels the heart: fraction of the ticks with a force", (run.norm("force")[settled] > 0).mean(), 0.99,
                    "fraction")


if __name__ == "__main__":
    sys.exit(main())
