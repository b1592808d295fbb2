"""The models of depth sensors against recordings of such sensors: noise, steps of depth, holes beside depth edges, and errors
against true objects. Both are measured by one code, depth_measures.py."""
import dataclasses
import math
import sys

import numpy as np
from depth_measures import Measured, depth_step_per_m, filled, fitted_windows, planar_scene, upper_median

import remote_touch as rt
from remote_touch.studies import dashed, dots, line, main, study
from remote_touch.theory import fit_polynomial

LOUD_SHARE = 0.9  # of the pixels, whose noise over time is in the tables
FLAT_SHARE = 0.25  # of the windows: those on curved surfaces have larger residuals than noise alone
FIRST_JUMP_PER_M, JUMP_BIN_PER_M = 0.2, 0.1
SHOWN_JUMP_PER_M = (0.4, 0.7)  # of the edges in the table of holes
SHOWN_PX, BESIDE_PX = 40, 3  # distances from an edge
FEWEST_WIDTHS = 4
TRUTH_FRAME_STEP = 3
SILHOUETTE_PX, OTHER_SURFACE_M = 3, 0.05

LABELS = {"recorded": "recorded", "simulated": "simulated", "own_focal": "simulated, own focal length"}
STYLES = {"recorded": dots, "simulated": line, "own_focal": dashed}
SIDES = ("left", "right")  # of near surfaces


@dataclasses.dataclass(frozen=True)
class Recorded:
    """A recording of a sensor. bounds_m: bounds of the ranges of distance. Steps of depth are larger than the unit of depth in
    step_m. Beyond last_jump_per_m there are few edges."""
    name: str
    title: str
    experiment: str  # plays a recording; its own path is replaced
    recording: str
    frames: int
    is_at_rest: bool
    step_m: tuple
    bounds_m: tuple
    last_jump_per_m: float

    def ranges(self):
        return [*zip(self.bounds_m, self.bounds_m[1:])]


ACTIVE_STEREO = Recorded("active_stereo", "Active stereo", "fig4.16-moving", "rgbd/visp_cube_dragon", frames=5, is_at_rest=True,
                         step_m=(1, 1.3), bounds_m=(0.3, 0.45, 0.6, 0.8, 1, 1.3), last_jump_per_m=1)
STRUCTURED_LIGHT = Recorded("structured_light", "Structured light", "fig4.16-boxes", "rgbd/pcd_single", frames=2, is_at_rest=False,
                            step_m=(0.9, 2), bounds_m=(0.5, 0.65, 0.8, 1, 1.2, 1.5, 2), last_jump_per_m=0.7)


class Comparison:
    """A recorded sensor, the model of its kind with published numbers and the focal length of the recorded images, and the model
    with the focal length of the sensor's own images, f: that for which the steps of disparity have the published size.

    The models see the recorded scene with filled holes, and for noise about planes the planes that were fitted to it. If the scene
    is at rest, it is that of the first frame.
    """

    def __init__(self, s, recorded):
        self.shown = recorded
        self.scene = rt.scene(**s.uses(recorded.experiment, {"scenario.path": recorded.recording})["scenario"])
        clouds = [self.scene.cloud(frame) for frame in range(recorded.frames)]
        self.camera, images = clouds[0].camera, [cloud.depth for cloud in clouds]
        self.sensor = {"sensor": recorded.name.replace("_", "-"), "width": self.camera["width"], "height": self.camera["height"],
                       "focal_px": self.camera["fx"]}
        published = rt.DepthSensor(**self.sensor).triangulation
        self.focal_px, self.baseline_m = self.camera["fx"], published["baseline_m"]
        measured = Measured(images, recorded.is_at_rest, images)
        self.own_focal_px = published["step_px"] / (depth_step_per_m(measured.depths_m, *recorded.step_m) * self.baseline_m)
        # Warped to a longer focal length, all lengths in pixels of disparity grow, and so does the matching window.
        own_window_px = math.floor(published["window_px"] * self.focal_px / self.own_focal_px + 0.5)
        own = {"disparity_focal_px": self.own_focal_px, "window_px": max(1, own_window_px)}
        self.sources = {"recorded": measured, "simulated": self.simulated(images, {}), "own_focal": self.simulated(images, own)}

    def simulated(self, images, settings):
        sensor = rt.DepthSensor(**self.sensor, **settings)
        # Lateral noise moves edges, and the edges between the planes are none of the recorded scene.
        of_planes = rt.DepthSensor(**self.sensor, **settings, lateral_noise_px=0)
        planes = [of_planes.measured(*planar_scene(fitted_windows(image), self.camera))[0] for image in images]
        if self.shown.is_at_rest:
            return Measured(sensor.measured(filled(images[0]), frames=range(len(images))), True, planes)
        return Measured([sensor.measured(filled(image))[0] for image in images], False, planes)

    def table(self, what):
        return f"{what}_{self.shown.name}"

    def over_time_m(self, source, place, share=0.5):
        """The standard deviation of a pixel's depth over time which that share of the pixels does not exceed."""
        depth_m, per_m = self.sources[source].noise_over_time(*self.shown.ranges()[place], share)
        return per_m * depth_m**2

    def about_planes(self, source, place):
        """The rms about the plane of a window, lower quartile: in m, and of the disparity in pixels."""
        depth_m, per_m = self.sources[source].noise_about_planes(*self.shown.ranges()[place], FLAT_SHARE)
        return np.array([per_m * depth_m**2, per_m * self.focal_px * self.baseline_m])

    def holes_px(self, source, side, jump_per_m=SHOWN_JUMP_PER_M):
        return self.sources[source].holes_px(side == "left", *jump_per_m)


def hole_fraction(holes_px, distance_px):
    """The share of the edges at which the pixel so many pixels beyond the nearer surface, counted from 1, is a hole."""
    return np.mean(holes_px >= distance_px) if len(holes_px) else math.nan


def add_noise(s, compared):
    ranges, shown = compared.shown.ranges(), compared.shown
    places, middles_m = range(len(ranges)), np.array([0.5 * (near_m + far_m) for near_m, far_m in ranges])
    columns = {"depth": (middles_m, "m", "middle of the range of depth")}
    for source, label in LABELS.items():
        if shown.is_at_rest:
            columns[f"time_{source}"] = ([compared.over_time_m(source, i) for i in places], "m",
                                         f"median standard deviation of a pixel's depth over time, {label}")
            columns[f"loud_{source}"] = ([compared.over_time_m(source, i, LOUD_SHARE) for i in places], "m",
                                         f"standard deviation that 90 % of the pixels do not exceed, {label}")
        planes_m, planes_px = np.transpose([compared.about_planes(source, i) for i in places])
        columns[f"planes_{source}"] = planes_m, "m", f"rms of depth about the plane of a window, lower quartile, {label}"
        columns[f"planes_px_{source}"] = planes_px, "px", f"rms of disparity about the plane of a window, lower quartile, {label}"
        steps_per_m = np.array([depth_step_per_m(compared.sources[source].depths_m, *of) for of in ranges])
        columns[f"step_{source}"] = steps_per_m * middles_m * middles_m, "m", f"step of depth, {label}"
    return s.table(compared.table("noise"), f"{shown.title}: noise and steps over distance", columns)


def add_widths(s, compared):
    """The medians of the widths of holes, over jumps of inverse depth."""
    lows = np.cumsum([FIRST_JUMP_PER_M] + 20 * [JUMP_BIN_PER_M])
    lows = lows[lows < compared.shown.last_jump_per_m - 1e-9]
    columns = {"jump": (lows + 0.5 * JUMP_BIN_PER_M, "1/m", "jump of inverse depth at the edge")}
    for side in SIDES:
        for source, label in LABELS.items():
            widths = [upper_median(compared.holes_px(source, side, (low, low + JUMP_BIN_PER_M)), fewest=20) for low in lows]
            columns[f"{side}_{source}"] = widths, "px", f"median width of holes, {side} of near surfaces, {label}"
    return s.table(compared.table("widths"), f"{compared.shown.title}: width of the holes at depth edges", columns)


def add_holes(s, compared):
    distances = np.arange(1, SHOWN_PX + 1)
    columns = {"distance": (distances, "px", "distance from the last pixel of the nearer surface")}
    for side in SIDES:
        for source, label in LABELS.items():
            holes_px = compared.holes_px(source, side)
            columns[f"{side}_{source}"] = ([hole_fraction(holes_px, distance) for distance in distances], "1",
                                           f"fraction of holes, {side} of near surfaces, {label}")
    s.table(compared.table("holes"), f"{compared.shown.title}: holes beside edges with a jump of 0.4 to 0.7 per m", columns)


def add_panels(s, compared, column):
    noise, title = compared.table("noise"), compared.shown.title

    def over_depth(what, row, y_label, quantity):
        s.panel(f"{title}: {what}", "depth (m)", y_label, [
            STYLES[source](noise, "depth", f"{quantity}_{source}", label) for source, label in LABELS.items()], at=(row, column))

    def of_sides(what, row, x_label, y_label, table, x):
        # The own focal length does not change holes.
        s.panel(f"{title}: {what}", x_label, y_label, [
            STYLES[source](compared.table(table), x, f"{side}_{source}", f"{source}, {side} of near surfaces")
            for side in SIDES for source in ("recorded", "simulated")], at=(row, column))
    if compared.shown.is_at_rest:
        over_depth("noise over time", 0, "standard deviation (m)", "time")
    over_depth("noise about planes", 1, "rms (m)", "planes")
    over_depth("step of depth", 2, "step (m)", "step")
    of_sides("holes at edges", 3, "jump of 1 / z (1/m)", "median width (px)", "widths", "jump")
    of_sides("holes beside edges", 4, "distance from the edge (px)", "fraction of holes", "holes", "distance")


def cosines(image, camera):
    """The cosine of the angle between the ray of a pixel and the normal of what it sees; 1 where it sees nothing."""
    x = (np.arange(camera["width"]) - camera["cx"]) / camera["fx"]
    y = (np.arange(camera["height"])[:, None] - camera["cy"]) / camera["fy"]
    normal_x, normal_y, normal_z = np.moveaxis(image["normals"], -1, 0)
    return np.where(image["object"] < 0, 1, np.abs(normal_x * x + normal_y * y + normal_z) / np.sqrt(x * x + y * y + 1))


def object_errors(image, measured, object):
    """Median and standard deviation of depth minus true depth, and the share of the pixels with a depth; NaN if none shows the
    object. Left out of the errors are pixels less than 3 pixels from another object in their row or column, and errors of other
    surfaces."""
    shows = image["object"] == object
    inside = np.zeros_like(shows)
    height, width = np.subtract(shows.shape, 2 * SILHOUETTE_PX)
    middle, shifts = slice(SILHOUETTE_PX, -SILHOUETTE_PX), range(2 * SILHOUETTE_PX + 1)
    inside[middle, middle] = np.all([shows[middle, d:d + width] & shows[d:d + height, middle] for d in shifts], axis=0)
    errors_m = (measured - image["depth"])[inside]
    errors_m = errors_m[np.abs(errors_m) < OTHER_SURFACE_M]
    share = np.mean(~np.isnan(measured[shows])) if shows.any() else math.nan
    if not len(errors_m):
        return math.nan, math.nan, share
    return upper_median(errors_m), np.std(errors_m, ddof=1), share


def add_truth(s, compared):
    """Errors on the true objects of a recording: of the sensor, and of the model that sees the objects alone at their poses."""
    scene, sensor = compared.scene, rt.DepthSensor(**compared.sensor)
    objects = [name for name, _ in scene.true_objects(0)]
    frames, errors = range(0, scene.frame_count, TRUTH_FRAME_STEP), []
    for frame in frames:
        cloud, time_s = scene.cloud(frame), scene.captured_s(frame)
        seen = scene.true_image(time_s, compared.camera, cloud.camera_pose)
        alone = scene.true_image(time_s, sensor.camera, cloud.camera_pose)
        modelled, = sensor.measured(alone["depth"], cosines(alone, sensor.camera), frames=[frame])
        errors.append([[object_errors(image, measured, k) for image, measured in ((seen, cloud.depth), (alone, modelled))]
                       for k in range(len(objects))])
    errors = np.array(errors)  # frame, object, source, value
    columns = {"frame": (frames, "1", "frame of the recording")}
    for k, name in enumerate(objects):
        for i, source in enumerate(("recorded", "simulated")):
            of = f"{name}_{source}", f"{name}, {source}"
            for value, (what, unit, text) in enumerate((
                    ("median", "m", "median error of depth"), ("spread", "m", "standard deviation of the error of depth"),
                    ("measured", "1", "share of the pixels with a depth"))):
                columns[f"{what}_{of[0]}"] = errors[:, k, i, value], unit, f"{text} on the {of[1]}"
    truth = s.table("truth", "Active stereo: depth minus the depth of true objects", columns)
    s.panel("Active stereo: depth minus true depth", "frame", "median over the object (m)", [
        STYLES[source]("truth", "frame", f"median_{name}_{source}", f"{name}, {source}")
        for name in ("cube", "dragon") for source in ("recorded", "simulated")], at=(0, 1))
    add_truth_claims(s, truth)


def add_truth_claims(s, truth):
    claims = s.claims("active stereo: ")

    def ratio(of, column):
        return of(truth[f"{column}_simulated"]) / of(truth[f"{column}_recorded"])
    for name in ("cube", "dragon"):
        claims.differs(f"the sensor's mean error on the true {name} changes over the frames, that of the model does not: standard "
                       "deviation of the frame's median, simulated / recorded",
                       ratio(lambda errors_m: np.nanstd(errors_m, ddof=1), f"median_{name}"), 0, 0.05, "ratio", "1 (equal)")
        claims.differs(f"errors on the true {name} are spread less in the model: standard deviation in frame 0, simulated / "
                       "recorded", ratio(lambda spread_m: spread_m[0], f"spread_{name}"), 0.23, 0.3, "ratio", "1 (equal)")
    claims.differs("the model loses more of the true table, which is seen at 78 to 88 degrees: share of the pixels with a depth, "
                   "simulated / recorded", ratio(np.nanmean, "measured_table"), 0.9, 0.94, "ratio", "1 (equal)")


def add_range_claims(claims, text, simulated, recorded, factor):
    """About a ratio, simulated / recorded, in every range of distance but the first."""
    ratios = (simulated / recorded)[1:]
    claims.at_least(f"{text}: smallest simulated / recorded", ratios.min(), 1 / factor, "ratio", "1 (equal)")
    claims.at_most(f"{text}: largest simulated / recorded", ratios.max(), factor, "ratio", "1 (equal)")


def width_ratio(compared):
    simulated_px, recorded_px = (upper_median(compared.holes_px(source, "left"), fewest=20) for source in ("simulated", "recorded"))
    return simulated_px / recorded_px


def shadow_baseline_m(widths, column, focal_px):
    """How fast the holes widen with the jump of inverse depth, as the length of a baseline; NaN if too few widths are known."""
    known = ~np.isnan(widths[column])
    if known.sum() < FEWEST_WIDTHS:
        return math.nan
    return fit_polynomial(widths.jump[known], np.array(widths[column])[known], [0, 1])[1] / focal_px


def add_active_stereo_claims(s, compared, noise, widths):
    claims, equal = s.claims("active stereo: "), ("ratio", "1 (equal)")
    simulated, own = noise.time_simulated / noise.time_recorded, noise.time_own_focal / noise.time_recorded
    claims.differs("steps of depth show that the images were warped from a camera of shorter focal length: 1/32 px / (50 mm x step "
                   "of 1 / z)", compared.own_focal_px, 375, 390, "px", "607")
    of_images = "with the focal length of the images the model has too little noise over time: simulated / recorded at "
    claims.differs(of_images + "0.6 to 0.8 m", simulated[2], 0.62, 0.67, *equal)
    claims.differs(of_images + "1 to 1.3 m", simulated[4], 0.57, 0.62, *equal)
    add_range_claims(claims, "with its own focal length the model has the sensor's noise over time from 0.45 m on",
                     noise.time_own_focal, noise.time_recorded, 1.4)
    claims.differs("nearer than 0.45 m the recording, in whole millimetres, has more noise over time than the model with its own "
                   "focal length: simulated / recorded", own[0], 0.38, 0.42, *equal)
    claims.differs("the sensor has pixels with far more noise over time than the median: 90 % quantile, simulated / recorded at "
                   "0.6 to 0.8 m, with its own focal length", noise.loud_own_focal[2] / noise.loud_recorded[2], 0.44, 0.49, *equal)
    add_range_claims(claims, "the model has the sensor's noise about planes from 0.45 m on", noise.planes_simulated,
                     noise.planes_recorded, 1.35)
    claims.differs("holes left of near surfaces are narrower in the model: median width, simulated / recorded",
                   width_ratio(compared), 0.67, 0.72, *equal)
    claims.between("holes left of near surfaces widen with the jump of 1 / z as by the baseline: recorded slope / focal length",
                   shadow_baseline_m(widths, "left_recorded", compared.focal_px), 0.04, 0.06, "m", "0.05")
    claims.differs("the sensor also has holes right of near surfaces: recorded fraction of holes 3 px away",
                   hole_fraction(compared.holes_px("recorded", "right"), BESIDE_PX), 0.65, 0.69, "fraction", "0")


def add_structured_light_claims(s, compared, noise, widths):
    claims = s.claims("structured light: ")
    left_m, right_m = (shadow_baseline_m(widths, f"{side}_recorded", compared.focal_px) for side in SIDES)
    claims.between("steps of depth show the focal length of the infrared camera: 1/8 px / (75 mm x step of 1 / z)",
                   compared.own_focal_px, 565, 595, "px", "580")
    add_range_claims(claims, "the model has the sensor's noise about planes from 0.65 m on", noise.planes_simulated,
                     noise.planes_recorded, 1.3)
    claims.differs("nearer than 0.65 m the sensor has more noise about planes: simulated / recorded",
                   noise.planes_simulated[0] / noise.planes_recorded[0], 0.69, 0.74, "ratio", "1 (equal)")
    claims.differs("holes left of near surfaces are wider in the model: median width, simulated / recorded",
                   width_ratio(compared), 1.57, 1.66, "ratio", "1 (equal)")
    claims.differs("the sensor also has holes right of near surfaces: recorded fraction of holes 3 px away",
                   hole_fraction(compared.holes_px("recorded", "right"), BESIDE_PX), 0.94, 0.97, "fraction", "0")
    claims.differs("holes left of near surfaces widen with the jump of 1 / z less than by the baseline: recorded slope / focal "
                   "length", left_m, 0.057, 0.061, "m", "0.075")
    claims.differs("holes right of near surfaces widen with the jump of 1 / z: recorded slope / focal length", right_m, 0.023,
                   0.026, "m", "0")
    claims.between("holes on both sides together widen with the jump of 1 / z as by the baseline: sum of the recorded slopes / "
                   "focal length", left_m + right_m, 0.064, 0.087, "m", "0.075")


@study("sensor-models-recorded", "simulated depth sensors against recordings of real ones: noise, steps of depth, holes at edges",
       title="Simulated depth sensors against real ones", source="the published models", caption="""
       The models of mesh-scene's sensors, with published numbers only, and recordings of such sensors, measured by one code. Left:
       a D400 camera, five frames at rest. Right: two frames of a Kinect of 2010. The models see the recorded scenes with filled
       holes; for noise about planes they see the planes that fit windows of 20 x 20 pixels, and the lower quartile of the windows
       is shown. Both recordings are warped to the view of a colour camera with another focal length than the sensor's own. The
       steps of depth show the latter; dashed: the models with noise and steps of that focal length. Depth minus true depth is the
       median over the pixels of an object; the true poses are uncertain by 3 mm, but equally in all frames. Holes beside an edge
       begin behind the last pixel of the near surface; their edges have jumps of 0.4 to 0.7 per m. What the models lack: pixels
       with far more noise than the median, an error that drifts, holes right of near surfaces, and the margin of holes around the
       shadow of active stereo.""")
def sensor_models_recorded(s):
    for column, (recorded, add_claims) in enumerate(((ACTIVE_STEREO, add_active_stereo_claims),
                                                     (STRUCTURED_LIGHT, add_structured_light_claims))):
        compared = Comparison(s, recorded)
        noise, widths = add_noise(s, compared), add_widths(s, compared)
        add_holes(s, compared)
        add_panels(s, compared, column)
        add_claims(s, compared, noise, widths)
        if recorded is ACTIVE_STEREO:
            add_truth(s, compared)
        counts = [len(compared.holes_px(source, side)) for source in LABELS for side in SIDES]
        s.claims(set_up=True).at_least(f"{recorded.title}: fractions of holes are those of many edges: smallest number",
                                       min(counts), 200, "edges")


if __name__ == "__main__":
    sys.exit(main())
