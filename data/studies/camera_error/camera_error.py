"""The error of the renderer and the error of the camera, on recordings whose true surfaces are known."""
import concurrent.futures
import dataclasses
import json
import math
import os
import sys

import numpy as np
from true_contacts import FARTHEST_M, PIXEL_STEP, Toucher, TruthFrame, contact_errors, contact_points, pressing_experiment, \
    rotated, touched_points, upper_quantile, windows_around

import remote_touch as rt
from remote_touch.studies import band, dashed, dots, line, main, study

PROXY_REST_M, BALL_M = 0.005, 0.01  # r_c of Table 4.2; radius of the tool `ball`
SIGMA_F_M = 0.025  # the default
MOST_OBJECTS, MOST_FRAMES, POINT_FRAME_STEP = 3, 150, 10
ASSUMED_UNCERTAINTY_M = 0.003  # if nothing is stated


@dataclasses.dataclass(frozen=True)
class Recording:
    """uncertainty_m: of its truth, by the description of the recording; its truth.json may state another. objects: the largest
    number that are touched."""
    path: str
    title: str
    uncertainty_m: float
    objects: int


RECORDINGS = (Recording("rgbd/visp_cube_dragon", "", 0.003, 2),
              Recording("rgbd/visp_teabox_synthetic", "rendered ", 0, 1))

# Three renderers are compared over the frames: the proxy, the tracked sheet, and a ball of 10 mm radius behind the
# default depth pipeline.
RENDERERS = (Toucher("proxy", {"name": "proxy"}, PROXY_REST_M), Toucher("tracked sheet", {"name": "tracked-sheet"}, PROXY_REST_M),
             Toucher("ball as tool", {"name": "tool", "tool_mesh": "ball"}, BALL_M, depth_pipeline={}))


@dataclasses.dataclass(frozen=True)
class Setting:
    """What filters depth images before the proxy touches their points: window_px, the width of the spatial filter (7.1), 1 if there
    is none; sigma_f_m of (7.2); or average of the renderer averaged-proxy, which filters over time."""
    name: str
    window_px: int = 1
    sigma_f_m: float = SIGMA_F_M
    average: str = ""

    def toucher(self):
        """The proxy behind the setting. It does not use normals, so the pipeline computes them in the fastest way."""
        if self.average:
            return Toucher(self.name, {"name": "averaged-proxy", "average": self.average}, PROXY_REST_M)
        pipeline = {**self.pipeline(), "normal_window": 3, "normal_fit": "inverse-depth"} if self.window_px > 1 else None
        return Toucher(self.name, {"name": "proxy"}, PROXY_REST_M, pipeline)

    def pipeline(self):
        return {"filter_window": self.window_px, "sigma_f_m": self.sigma_f_m} if self.window_px > 1 else {"filter": False}


SETTINGS = (Setting("no filter"), Setting("3 x 3 pixels", 3), Setting("5 x 5 pixels", 5), Setting("9 x 9 pixels, the default", 9),
            Setting("15 x 15 pixels", 15), Setting("9 x 9 pixels, sigma_f = 5 mm", 9, 0.005),
            Setting("filter over time", average="exponential"), Setting("mean of four frames", average="mean"))
SPATIAL = [i for i, setting in enumerate(SETTINGS) if not setting.average]
OVER_TIME = [i for i, setting in enumerate(SETTINGS) if setting.average]
BY_WINDOW = [i for i in SPATIAL if SETTINGS[i].sigma_f_m == SIGMA_F_M]  # those that differ in their window only
DEFAULT = 3


def rms(values, offset=0):
    known = values[~np.isnan(values)] + offset
    return math.sqrt(np.mean(known**2)) if len(known) else math.nan


def mean(values):
    return np.mean(values[~np.isnan(values)]) if known_frames(values) else math.nan


def known_frames(values):
    return (~np.isnan(values)).sum()


def frame_noise_m(values):
    """The rms change from one frame to the next, divided by the square root of 2: the standard deviation of errors that are
    independent in each frame."""
    return rms(np.diff(values)) / math.sqrt(2)


@dataclasses.dataclass
class PointErrors:
    """Of the points of an object behind a setting: distances to both surfaces, m, and angles to the true normals, deg."""
    pixels: int
    to_measured: float
    to_true: float
    mean: float  # signed, positive outside
    to_true_90: float  # 90 % of the points are nearer to the true surface
    normal: float  # median

    @classmethod
    def of(cls, measured, true, angle):
        angle = angle[~np.isnan(angle)]
        normal = upper_quantile(angle, 0.5) if len(angle) else math.nan
        nearer = upper_quantile(np.abs(true), 0.9) if len(true) else math.nan
        return cls(len(true), rms(measured), rms(true), mean(true), nearer, normal)


NO_POINTS = PointErrors(0, *5 * (math.nan,))


@dataclasses.dataclass
class TouchedObject:
    """The errors on one true object. settings: over the frames that all of them know; known: the frames that each knows alone."""
    table: str
    title: str
    uncertainty_m: float
    captured_s: np.ndarray
    renderers: list
    settings: list
    known: list
    points: list  # of the spatial settings

    def contacts_to_measured_m(self):
        return np.array([rms(self.settings[i].renderer) for i in SPATIAL])

    def contacts_to_true_m(self, offset_m=0):
        """offset_m moves the truth away from the camera, along the normal of the surface."""
        return np.array([rms(self.settings[i].total, offset_m) for i in SPATIAL])

    def points_m(self, surface):
        return np.array([getattr(errors, surface) for errors in self.points])


def best_of(values):
    """The setting with the smallest value; NaN is never the best."""
    return int(np.argmin(np.nan_to_num(values, nan=np.inf)))


# --- the errors ---

def judged_objects(s, recording, number, settings):
    """The errors of each touched object of a recording."""
    config = s.uses({"scenario": {"name": "recording", "path": recording.path, "truth": "mesh"}, "renderer": {"name": "proxy"},
                     "trajectory": {"name": "poses"}, "duration_s": 1}, settings)
    scenario = config["scenario"]
    scene = rt.scene(**scenario)
    if not scene.true_objects(0):
        raise rt.InputError("figure camera-error: its scenario has no true meshes: expected a recording with truth/")
    frames = min(scene.frame_count, MOST_FRAMES)
    points = touched_points(scene, frames // 2, recording.objects)
    if not points:
        raise rt.InputError(f"{scenario['path']}: no true object can be touched in frame {frames // 2}: expected a measured "
                            "surface without holes and edges within 10 mm")
    captured_s = np.array([scene.captured_s(frame) for frame in range(frames)])
    windows = windows_around(points, scene, frames)
    contacts = all_contact_errors(s, scene, windows, scenario, captured_s)
    of_points = point_errors(scene, [point.index for point in points], frames, scenario["truth_radius_m"])
    stated_m = scene.truth_uncertainty_m
    for i, (point, errors) in enumerate(zip(points, contacts)):
        renderers, of_settings = errors[:len(RENDERERS)], errors[len(RENDERERS):]
        common = ~np.isnan([each.total for each in of_settings]).any(axis=0)
        yield TouchedObject(f"recording_{number}_object_{i + 1}", recording.title + point.name,
                            recording.uncertainty_m if math.isnan(stated_m) else stated_m, captured_s, renderers,
                            [each.only(common) for each in of_settings], [known_frames(each.total) for each in of_settings],
                            of_points[i])


def all_contact_errors(s, scene, windows, scenario, captured_s):
    """The errors of each toucher on each window. The runs are made side by side."""
    touchers = [*RENDERERS, *(setting.toucher() for setting in SETTINGS)]
    experiments = [[pressing_experiment(scenario, window, toucher, captured_s) for toucher in touchers] for window in windows]
    for of_window in experiments:
        s.uses(of_window[0])
    with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as threads:
        runs = [[threads.submit(contact_points, experiment, window, toucher.rest_distance_m, captured_s)
                 for experiment, toucher in zip(of_window, touchers)] for window, of_window in zip(windows, experiments)]
        contacts_W = np.array([[run.result() for run in of_window] for of_window in runs])
    return contact_errors(contacts_W, windows, scene, captured_s)


def point_errors(scene, objects, frames, radius_m):
    """The errors of the points and normals that the spatial settings make of every tenth frame, over the pixels that show one of
    the objects, in every third row and column. A pixel belongs to the object that the camera would see there without errors, and is
    used if its measured depth is near the true one, and every setting has a point there with a distance to both surfaces."""
    samples = [frame_samples(scene, TruthFrame(scene, number), objects, radius_m) for number in range(0, frames, POINT_FRAME_STEP)]
    shown, values = (np.concatenate(of, axis=-1) for of in zip(*samples))  # values: setting, (measured, true, angle), pixel
    known = ~np.isnan(values[:, :2]).any(axis=(0, 1))
    return [[PointErrors.of(*of[:, known & (shown == k)]) for of in values] for k in objects]


def frame_samples(scene, frame, objects, radius_m):
    """The object of each pixel of a frame, and for each setting the distances of its point to the measured and the true surface,
    and the angle between its normal and the true one. Only the rectangle around the pixels is processed."""
    rows, columns = (at[::PIXEL_STEP, ::PIXEL_STEP].ravel() for at in np.indices(frame.object.shape))
    near = np.abs(frame.depth - frame.exact_depth)[rows, columns] <= FARTHEST_M  # false for NaN
    chosen = near & np.isin(frame.object[rows, columns], objects)
    if not chosen.any():
        return np.empty(0), np.empty((len(SPATIAL), 3, 0))
    rows, columns = rows[chosen], columns[chosen]
    left, top, width, height = columns.min(), rows.min(), np.ptp(columns) + 1, np.ptp(rows) + 1
    pixels = (rows - top) * width + columns - left
    made = []
    for i in SPATIAL:
        cloud = frame.cloud.filtered(left, top, width, height, **SETTINGS[i].pipeline())
        points_W, normals_C = cloud.points[pixels], rotated(frame.X_CW, cloud.normals[pixels])
        made.append([frame.cloud.surface_distances(points_W, radius_m), scene.signed_distances(points_W, frame.time_s),
                     angles_deg(normals_C, frame.normals_C[rows, columns])])
    return frame.object[rows, columns], np.array(made)


def angles_deg(a, b):
    a, b = (of / np.linalg.norm(of, axis=1, keepdims=True) for of in (a, b))
    return np.degrees(2 * np.arctan2(np.linalg.norm(a - b, axis=1), np.linalg.norm(a + b, axis=1)))


# --- the figure ---

def add_object(s, of, last_frame):
    """Tables of an object, and a panel of the errors of the proxy over the frames."""
    frames, windows, averages = (f"{of.table}_{what}" for what in ("frames", "windows", "averages"))
    uncertainty_m = of.uncertainty_m
    count = len(of.captured_s)
    columns = {"frame": (np.arange(count), "1", "frame of the recording"), "time": (of.captured_s, "s", "time of capture"),
               "truth_low": (np.full(count, -uncertainty_m), "m", "uncertainty of the truth, towards the object"),
               "truth_high": (np.full(count, uncertainty_m), "m", "uncertainty of the truth, outwards")}
    for renderer, errors in zip(RENDERERS, of.renderers):
        name = renderer.name.replace(" ", "_")
        columns[f"{name}_renderer"] = (errors.renderer, "m",
                                       f"{renderer.name}: height of the contact point over the measured surface")
        columns[f"{name}_camera"] = (errors.camera, "m",
                                     f"{renderer.name}: height of the measured surface over the true one, at the contact point")
    s.table(frames, f"{of.title}: errors in each frame", columns)
    add_windows(s, of, windows, averages)
    largest_m = max(uncertainty_m, np.nanmax(np.abs([of.renderers[0].renderer, of.renderers[0].camera]), initial=0))
    s.panel(f"{of.title}, touched by the proxy", "frame", "error (m)", [
        band(frames, "frame", "truth_low", "true surface, uncertainty", "truth_high"),
        line(frames, "frame", "proxy_camera", "camera: measured over true surface"),
        line(frames, "frame", "proxy_renderer", "contact point over measured surface")],
        x_range=(0, last_frame), y_range=(-1.1 * largest_m, 1.1 * largest_m))


def rms_range_m(errors, uncertainty_m):
    """The smallest and the largest rms height of the contact point over the true surface if the truth is moved by up to its
    uncertainty."""
    mean_m = mean(errors.total)
    return (rms(errors.total, np.clip(-mean_m, -uncertainty_m, uncertainty_m)),
            rms(errors.total, -uncertainty_m if mean_m < 0 else uncertainty_m))


def add_windows(s, of, windows, averages):
    def heights(settings, spatial=""):
        return {"window": ([SETTINGS[i].window_px for i in settings], "1", f"width of the {spatial}filter, pixels; 1: no filter"),
                "to_measured": ([rms(of.settings[i].renderer) for i in settings], "m",
                                "rms height of the contact point over the measured surface"),
                "to_true": ([rms(of.settings[i].total) for i in settings], "m",
                            "rms height of the contact point over the true surface")}
    low_m, high_m = np.transpose([rms_range_m(of.settings[i], of.uncertainty_m) for i in BY_WINDOW])
    s.table(windows, f"{of.title}: the proxy behind spatial filters", {
        **heights(BY_WINDOW), "to_true_low": (low_m, "m", "its smallest value if the truth is moved by up to its uncertainty"),
        "to_true_high": (high_m, "m", "its largest value then")})
    s.table(averages, f"{of.title}: the proxy behind filters over time", heights(OVER_TIME, "spatial "))


def add_comparisons(s, objects):
    """Tables over all objects: the renderers, the settings, and the best of them; a panel of the renderers, and one of the
    errors of all points."""
    of_renderers = [(of, name.name, errors) for of in objects for name, errors in zip(RENDERERS, of.renderers)]
    all_errors = [errors for _, _, errors in of_renderers]
    s.table("renderers", "errors over the frames, by renderer",
            object=([of.title for of, _, _ in of_renderers], "1", "recording and object"),
            renderer=([name for _, name, _ in of_renderers], "1", "what touches the object"),
            frames=([known_frames(e.camera) for e in all_errors], "1", "frames in which both errors are known"),
            renderer_rms=([rms(e.renderer) for e in all_errors], "m", "rms height of the contact point over the measured surface"),
            renderer_mean=([mean(e.renderer) for e in all_errors], "m", "its mean"),
            camera_rms=([rms(e.camera) for e in all_errors], "m", "rms height of the measured surface over the true one"),
            camera_mean=([mean(e.camera) for e in all_errors], "m", "its mean"),
            total_rms=([rms(e.total) for e in all_errors], "m", "rms height of the contact point over the true surface"),
            renderer_noise=([frame_noise_m(e.renderer) for e in all_errors], "m",
                            "rms change of the renderer's error in a frame / sqrt(2)"),
            camera_noise=([frame_noise_m(e.camera) for e in all_errors], "m",
                          "rms change of the camera's error in a frame / sqrt(2)"),
            uncertainty=([of.uncertainty_m for of, _, _ in of_renderers], "m", "uncertainty of the truth"))
    add_renderers_panel(s, objects)
    add_settings(s, objects)
    add_best(s, objects)
    quantities = {"to_measured": ("m", "rms distance to the measured surface"),
                  "to_true": ("m", "rms distance to the true surface"),
                  "normal": ("deg", "median angle between normal and true normal")}
    s.table("points", "all points of the objects, behind spatial filters", {
        "window": ([SETTINGS[i].window_px for i in BY_WINDOW], "1", "width of the filter, pixels; 1: no filter"),
        **{f"{of.table}_{name}": (of.points_m(name)[BY_WINDOW], unit, f"{of.title}: {text}")
           for of in objects for name, (unit, text) in quantities.items()}})
    s.panel("Distance of all points to the measured and the true surface", "filter window (px)", "rms distance (m)",
            [make("points", "window", f"{of.table}_{surface}", f"{of.title}, {words}") for of in objects
             for make, surface, words in ((line, "to_measured", "measured"), (dashed, "to_true", "true"))])


def add_renderers_panel(s, objects):
    """The rms errors of the three renderers and of the camera, whose error differs little between their contact points."""
    s.table("rms", "rms errors over the frames",
            object=(np.arange(len(objects), dtype=np.int32), "1", "object", [of.title for of in objects]),
            camera=([rms(of.renderers[0].camera) for of in objects], "m", "rms height of the measured surface over the true one"),
            **{f"renderer_{i}": ([rms(of.renderers[i].renderer) for of in objects], "m",
                                 f"{renderer.name}: rms height of the contact point over the measured surface")
               for i, renderer in enumerate(RENDERERS)})
    s.panel("Camera and renderers", "", "rms error (m)", [
        dots("rms", "object", "camera", "camera"),
        *(dots("rms", "object", f"renderer_{i}", renderer.name) for i, renderer in enumerate(RENDERERS))])


def add_settings(s, objects):
    rows = [(of, i, of.settings[i], of.points[i] if i in SPATIAL else NO_POINTS) for of in objects for i in range(len(SETTINGS))]

    def column(value, unit, text):
        return [value(*row) for row in rows], unit, text
    s.table("settings", "errors of the proxy and of all points of an object, by filter",
            object=column(lambda of, *_: of.title, "1", "recording and object"),
            setting=column(lambda of, i, *_: SETTINGS[i].name, "1", "filter of the depth images"),
            known_frames=column(lambda of, i, *_: of.known[i], "1", "frames in which both errors are known"),
            frames=column(lambda of, i, errors, _: known_frames(errors.total), "1",
                          "frames in which they are known for all filters, and over which contacts are compared"),
            contact_to_measured=column(lambda of, i, errors, _: rms(errors.renderer), "m",
                                       "rms height of the contact point over the measured surface"),
            contact_to_true=column(lambda of, i, errors, _: rms(errors.total), "m",
                                   "rms height of the contact point over the true surface"),
            contact_noise=column(lambda of, i, errors, _: frame_noise_m(errors.total), "m",
                                 "rms change of that height in a frame / sqrt(2)"),
            pixels=column(lambda *row: row[3].pixels, "1", "pixels whose points are compared below"),
            point_to_measured=column(lambda *row: row[3].to_measured, "m", "rms distance of the points to the measured surface"),
            point_to_true=column(lambda *row: row[3].to_true, "m", "rms distance of the points to the true surface"),
            point_mean=column(lambda *row: row[3].mean, "m",
                              "mean signed distance of the points to the true surface, positive outside"),
            point_to_true_90=column(lambda *row: row[3].to_true_90, "m",
                                    "90 % of the points are nearer to the true surface than this"),
            normal_angle=column(lambda *row: row[3].normal, "deg", "median angle between the normal and the true one"))


def add_best(s, objects):
    values = {"contact_by_measured": (TouchedObject.contacts_to_measured_m, "contact point of the proxy, by the measured surface"),
              "contact_by_true": (TouchedObject.contacts_to_true_m, "contact point of the proxy, by the true surface"),
              "contact_by_true_outwards": (lambda of: of.contacts_to_true_m(-of.uncertainty_m),
                                           "the same if the truth is farther outwards by its uncertainty"),
              "contact_by_true_inwards": (lambda of: of.contacts_to_true_m(of.uncertainty_m),
                                          "the same if the truth is farther inwards by its uncertainty"),
              "points_by_measured": (lambda of: of.points_m("to_measured"), "all points of the object, by the measured surface"),
              "points_by_true": (lambda of: of.points_m("to_true"), "all points of the object, by the true surface")}
    s.table("best", "the spatial filter with the smallest rms error",
            object=([of.title for of in objects], "1", "recording and object"),
            **{name: ([SETTINGS[best_of(value(of))].name for of in objects], "1", text) for name, (value, text) in values.items()})


def add_recording_claims(s, objects):
    """The claims about the two recordings of the figure. The limits were set after the figure had been seen."""
    claims = s.claims()
    for of in objects:
        if of.uncertainty_m == 0:
            for what in ("renderer", "camera"):
                claims.at_most(f"{of.title}: the {what} errs by less than the steps of the stored depth: largest rms error of "
                               "three renderers", np.max([rms(getattr(errors, what)) for errors in of.renderers]), 0.0006, "m")
        else:
            claims.at_least(f"{of.title}: the camera errs much more than the renderer: smallest ratio of their rms errors of three "
                            "renderers", np.min([rms(errors.camera) / rms(errors.renderer) for errors in of.renderers]), 5, "ratio")
    measured = [of for of in objects if of.uncertainty_m > 0]
    by_measured, by_true = (np.transpose([of.points_m(surface) for of in measured]) for surface in ("to_measured", "to_true"))
    claims.at_most("the best spatial filter brings the points near to the measured surface: largest rms distance of two objects, "
                   "divided by the one without a filter", (by_measured.min(axis=0) / by_measured[0]).max(), 0.3, "ratio")
    claims.at_least("no spatial filter brings the points nearer to the true surface: smallest rms distance of two objects, divided "
                    "by the one without a filter", (by_true.min(axis=0) / by_true[0]).min(), 0.95, "ratio")
    claims.at_most("the default filter is nearly the best by the true surface: largest rms distance of two objects, divided by the "
                   "one of the best setting", (by_true[DEFAULT] / by_true.min(axis=0)).max(), 1.02, "ratio")
    claims.at_least("while the camera moves, the filter over time does not bring the contact point nearer to the true surface: "
                    "smallest rms height of two objects, divided by the one without a filter",
                    np.min([rms(of.settings[OVER_TIME[0]].total) / rms(of.settings[0].total) for of in measured]), 0.95, "ratio")


def add_known_checks(s, objects):
    checks = s.claims(set_up=True)
    for of in objects:
        for renderer, errors in zip(RENDERERS, of.renderers):
            checks.at_least(f"{of.title}, {renderer.name}: both errors are known in most frames, of which a hand presses four "
                            "fifths: fraction of frames", known_frames(errors.total) / len(of.captured_s), 0.5, "fraction")


CAPTION = """with true objects: meshes, and their pose in each frame. A hand holds the middle of an object by its true pose, 10 mm
    behind the true surface, and comes again every 15 frames. The error of the renderer is the height of the contact point over the
    measured surface (a plane through the pixels within 6 mm); the error of the camera is the height of the measured surface over
    the true one at the same point. Their sum is the height over the true surface. Each frame is shown by its last tick; gaps are
    approaches, and frames in which one of the surfaces is unknown there. Band: the uncertainty of the truth, 3 mm if nothing else
    is stated. Dots: the rms of both errors, that of the renderer for three renderers. Bottom: every point of the objects in every tenth
    frame behind the spatial filter (7.1) of the depth pipeline, over the width of its window with sigma_f = 25 mm. The tables also
    have the frames of the other renderers, the proxy behind these filters and behind filters over time, and the normals."""


def settings_of(assignments):
    """The settings of the user, "scenario.path=DIR", as a dict."""
    settings = {}
    for assignment in assignments:
        path, _, text = assignment.partition("=")
        if not path.startswith("scenario."):
            raise rt.InputError(f"--set {assignment}: expected a setting of the recording, such as scenario.path=DIR")
        try:
            settings[path] = json.loads(text)
        except ValueError:
            settings[path] = text
    return settings


@study("camera-error", "error of the renderer and of the camera on recordings with true objects, over filters of depth images",
       title="Error of the renderer and error of the camera", caption="Two recordings " + CAPTION, takes_settings=True)
def camera_error(s):
    """Takes settings of the recording; scenario.path makes the study of one recording of the user."""
    settings, recordings = settings_of(s.overrides), RECORDINGS
    if "scenario.path" in settings:
        recordings = [Recording(str(settings["scenario.path"]), "", ASSUMED_UNCERTAINTY_M, MOST_OBJECTS)]
    objects = [of for number, recording in enumerate(recordings, 1) for of in judged_objects(s, recording, number, settings)]
    for of in objects:
        add_object(s, of, max(len(each.captured_s) for each in objects) - 1)
    add_comparisons(s, objects)
    if settings:
        s.caption = " ".join(f"A recording {CAPTION}".split())
    else:
        add_recording_claims(s, objects)
    add_known_checks(s, objects)


if __name__ == "__main__":
    sys.exit(main())
