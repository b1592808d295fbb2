"""Runs in which a hand presses a point of a true object of a recording, and the errors of renderer and camera at the contact.

Coordinates: W world, C camera, O object; a pose X_WO, 4 x 4, takes points from O to W.
"""
import dataclasses
import itertools
import math

import numpy as np

import remote_touch as rt

PIXEL_STEP = 3  # every third row and column is enough to find the middle of an object
MIN_FACING = 0.5  # cosine of the largest angle at which a surface is touched
FARTHEST_M = 0.03  # a measured depth farther from the true one shows something else
FLAT_REACH_M, FLAT_WITHIN_M = 0.015, 0.003
EDGE_JUMP_M, MARGIN_M = 0.006, 0.01  # of a surface that can be touched
WINDOW_M = 0.045  # half size that a window shows around its point
MEASURED_RADIUS_M = 0.006  # of the patch whose plane is the measured surface

PRESSED_M, APPROACHED_M, APPROACH_S = 0.01, 0.03, 0.1
CYCLE, APPROACH = 15, 3  # frames from one press to the next, and of its approach
HAPTIC_RATE_HZ, SAME_TIME_S = 1000, 5e-7


def dot(a, b):
    """Of vectors with three elements. Here and in moved(), sums have the order of the program, because a tool amplifies the
    rounding errors of its path."""
    x, y, z = np.moveaxis(a * b, -1, 0)
    return x + (y + z)


def rotated(X, vectors):
    return dot(X[:3, :3], vectors[..., None, :])


def moved(X, points):
    x, y, z = np.moveaxis(X[:3, :3] * points[..., None, :], -1, 0)
    return (x + y) + (z + X[:3, 3])


def inverse(X):
    made = np.eye(4)
    made[:3, :3] = X[:3, :3].T
    made[:3, 3] = -rotated(made, X[:3, 3])
    return made


def upper_quantile(values, share):
    """A value of the sample, without interpolation."""
    return np.sort(values, axis=None)[int(share * np.size(values))]


class TruthFrame:
    """A frame of a recording as the camera has measured it, and as it should have."""

    def __init__(self, scene, frame):
        self.time_s, self.cloud = scene.captured_s(frame), scene.cloud(frame)
        self.camera, self.X_CW, self.depth = self.cloud.camera, inverse(self.cloud.camera_pose), self.cloud.depth
        exact = scene.true_image(self.time_s, self.camera, self.cloud.camera_pose)
        self.exact_depth, self.object, self.normals_C = exact["depth"], exact["object"], exact["normals"]

    def true_points_C(self, rows, columns):
        z, c = self.exact_depth[rows, columns], self.camera
        return np.stack([(columns - c["cx"]) * z / c["fx"], (rows - c["cy"]) * z / c["fy"], z], axis=-1)

    def reach_px(self, focal_px, length_m, depth_m):
        """The length in pixels that a length has at a depth."""
        return int(np.clip(focal_px * length_m / depth_m, 1, max(self.depth.shape)))

    def supported_depth(self, row, column):
        """The median depth of the rectangle around a pixel that extends by MARGIN_M to each side; NaN if it has a hole or an edge,
        or reaches the border of the image."""
        z = self.depth[row, column]
        if not z > 0:
            return math.nan
        down, across = (self.reach_px(self.camera[focal], MARGIN_M, z) for focal in ("fy", "fx"))
        height, width = self.depth.shape
        if row <= down or column <= across or row + down >= height or column + across >= width:
            return math.nan
        around = self.depth[row - down - 1:row + down + 1, column - across - 1:column + across + 1]
        jump_m = np.max(np.abs([around[1:, 1:] - around[1:, :-1], around[1:, 1:] - around[:-1, 1:]]))
        return upper_quantile(around[1:, 1:], 0.5) if jump_m <= EDGE_JUMP_M else math.nan  # NaN at a hole

    def can_be_touched(self, row, column):
        return abs(self.supported_depth(row, column) - self.exact_depth[row, column]) <= FARTHEST_M  # false for NaN

    def is_flat_around(self, row, column):
        """The object is flat around the pixel, along the rows, columns and diagonals of the image."""
        p_C, reach = self.true_points_C(row, column), self.reach_px(self.camera["fx"], FLAT_REACH_M, self.exact_depth[row, column])
        rows, columns = (at.ravel() for at in np.meshgrid(*(at + reach * np.arange(-1, 2) for at in (row, column)), indexing="ij"))
        if min(row, column) < reach or rows.max() >= self.depth.shape[0] or columns.max() >= self.depth.shape[1]:
            return False
        heights_m = dot(self.true_points_C(rows, columns) - p_C, self.normals_C[row, column])
        return bool((self.object[rows, columns] == self.object[row, column]).all() and (np.abs(heights_m) <= FLAT_WITHIN_M).all())


@dataclasses.dataclass
class TouchedPoint:
    """A point of a true object, in the middle of the part that one frame shows. The hand comes along outwards: the normal of the
    mesh where it is flat around the point, else the direction to the camera in that frame."""
    name: str
    index: int  # of the object in Scene.true_objects()
    p_O: np.ndarray
    outwards_O: np.ndarray


def middle_of(frame, rows, columns):
    """The pixel nearest to the middle of these among those that can be touched, flat ones first, and whether it is flat; or
    None."""
    points_C = frame.true_points_C(rows, columns)
    facing = -dot(points_C, frame.normals_C[rows, columns]) / np.linalg.norm(points_C, axis=1) >= MIN_FACING
    order = np.argsort((rows - rows.mean())**2 + (columns - columns.mean())**2, kind="stable")
    first = None
    for i in order[facing[order]]:
        pixel = int(rows[i]), int(columns[i])
        if not frame.can_be_touched(*pixel):
            continue
        if frame.is_flat_around(*pixel):
            return pixel, True
        first = first or (pixel, False)
    return first


def touched_points(scene, frame_number, most):
    """The touched points of at most `most` objects, those first that fill the most pixels. The camera has measured a point within
    FARTHEST_M of the true depth there, and sees the mesh at 60 degrees or less from its normal."""
    frame, points = TruthFrame(scene, frame_number), []
    objects = scene.true_objects(frame.time_s)
    rows, columns = (at[::PIXEL_STEP, ::PIXEL_STEP] for at in np.indices(frame.object.shape))
    shown = [frame.object[::PIXEL_STEP, ::PIXEL_STEP] == k for k in range(len(objects))]
    for k in sorted(range(len(objects)), key=lambda k: -shown[k].sum()):
        middle = middle_of(frame, rows[shown[k]], columns[shown[k]]) if shown[k].any() and len(points) < most else None
        if middle:
            pixel, is_flat = middle
            p_C, (name, X_WO) = frame.true_points_C(*pixel), objects[k]
            outwards_C = frame.normals_C[pixel] if is_flat else -p_C / np.sqrt(dot(p_C, p_C))
            X_OC = inverse(frame.X_CW @ X_WO)
            points.append(TouchedPoint(name, k, moved(X_OC, p_C), rotated(X_OC, outwards_C)))
    return points


class Window:
    """The pixels around a touched point: the rectangle that shows WINDOW_M around it in all frames. A run that sees only these
    touches the same points as one that sees the whole frames, at a small part of the time. If the pose of the object is unknown in
    a frame, that of the last frame with a pose is used."""

    def __init__(self, point, camera, X_WO, X_WC):
        self.point, self.clouds, self.camera_W = point, [], np.array([pose[:3, 3] for pose in X_WC])
        self.rectangle = rectangle_around(camera, np.array([
            moved(inverse(camera_pose), moved(pose, point.p_O)) for pose, camera_pose in zip(X_WO, X_WC) if pose is not None]))
        known = [*itertools.accumulate(X_WO, lambda last, pose: last if pose is None else pose, initial=np.eye(4))][1:]
        self.p_W = np.array([moved(pose, point.p_O) for pose in known])
        self.outwards_W = np.array([rotated(pose, point.outwards_O) for pose in known])


def rectangle_around(camera, p_C):
    """Left, top, width and height of all pixels within WINDOW_M of one of the points, one pixel or more."""
    x, y, z = p_C[p_C[:, 2] > 0].T

    def first_and_count(centre_px, reach_px, size):
        ends = np.min(centre_px - reach_px, initial=size), np.max(centre_px + reach_px, initial=0)
        first, last = (int(np.clip(end, 0, size - 1)) for end in ends)
        return first, max(1, last - first + 1)
    reach_px = camera["fx"] * WINDOW_M / z
    left, width = first_and_count(camera["fx"] * x / z + camera["cx"], reach_px, camera["width"])
    top, height = first_and_count(camera["fy"] * y / z + camera["cy"], reach_px, camera["height"])
    return left, top, width, height


def windows_around(points, scene, frames):
    """A window for each point, with the first frames of the recording."""
    seen = [(scene.cloud(frame).camera_pose, scene.true_objects(scene.captured_s(frame))) for frame in range(frames)]
    windows = [Window(point, scene.cloud(0).camera, [objects[point.index][1] for _, objects in seen], [X_WC for X_WC, _ in seen])
               for point in points]
    for frame in range(frames):
        cloud = scene.cloud(frame)
        for window in windows:
            window.clouds.append(cloud.window(*window.rectangle))
    return windows


@dataclasses.dataclass
class Toucher:
    """A renderer that touches a recording, how its frames are processed before, and the distance of its reported position from a
    surface that it touches."""
    name: str
    renderer: dict
    rest_distance_m: float
    depth_pipeline: dict = None


def pressing_experiment(scenario, window, toucher, captured_s):
    """The experiment of a run over the recording. The hand moves with the true object. It comes to the point from 30 mm outwards
    within three frames, stays 10 mm behind the true surface for twelve, and comes again. At the end it presses for as long as an
    approach takes, so that a recording of few frames is touched too."""
    frames = np.arange(len(captured_s))
    approached = np.append(np.minimum(1, frames % CYCLE / APPROACH), 1)
    at = np.append(frames, frames[-1])
    hand_W = window.p_W[at] + (APPROACHED_M - approached * (APPROACHED_M + PRESSED_M))[:, None] * window.outwards_W[at]
    durations_s = [0, *np.diff(captured_s), APPROACH_S]
    poses = [[*p_W, 0, 0, 0, duration_s] for p_W, duration_s in zip(hand_W, durations_s)]
    return {"title": f"{toucher.name} pressed onto {window.point.name}, which is held by its true pose", "scenario": scenario,
            **({} if toucher.depth_pipeline is None else {"depth_pipeline": toucher.depth_pipeline}), "renderer": toucher.renderer,
            "trajectory": {"name": "poses", "poses": poses}, "duration_s": captured_s[-1] + APPROACH_S}


def contact_points(experiment, window, rest_distance_m, captured_s):
    """Runs the experiment on the window in place of its scenario. Returns the contact point in the last tick of each frame, world
    frame: rest_distance_m from the reported position, against the renderer's own normal. It is NaN if nothing is touched, or if the
    points are touched from behind, which the camera does not see. Each press has a renderer of its own, because a proxy that popped
    through would stay behind the points."""
    poses = np.array(experiment["trajectory"]["poses"])
    times_s = np.arange(math.ceil(experiment["duration_s"] * HAPTIC_RATE_HZ - 1e-6)) / HAPTIC_RATE_HZ
    hips_W = places(np.cumsum(poses[:, 6]), poses[:, :3], times_s)
    newest = (np.searchsorted(captured_s, times_s + SAME_TIME_S, side="right") - 1).clip(0)
    contacts_W, shown = np.full((len(captured_s), 3), np.nan), -1
    for tick, (time_s, hip_W, frame) in enumerate(zip(times_s, hips_W, newest)):
        if shown < 0 or frame // CYCLE != shown // CYCLE:
            renderer = rt.stepper(experiment)
        for arrived in range(shown + 1, frame + 1):
            renderer.frame(window.clouds[arrived], captured_s[arrived])
        shown = frame
        output = renderer.step(hip_W, time_s)
        if tick + 1 == len(newest) or newest[tick + 1] != frame:
            contact_W = output.proxy_m - rest_distance_m * output.normal
            if output.state != "free" and output.normal @ (window.camera_W[frame] - contact_W) > 0:
                contacts_W[frame] = contact_W
    return contacts_W


def places(arrival_s, positions, times_s):
    """The positions of a hand that moves straight from one to the next."""
    following = np.searchsorted(arrival_s, times_s, side="right").clip(1, len(arrival_s) - 1)
    before = following - 1
    share = ((times_s - arrival_s[before]) / (arrival_s[following] - arrival_s[before])).clip(0, 1)
    return positions[before] + share[:, None] * (positions[following] - positions[before])


class ContactErrors:
    """Heights in each frame, m: of the contact point over the measured surface, of the measured surface over the true one at the
    contact point, and their sum, of the contact point over the true surface. NaN if the contact or a surface is unknown."""

    def __init__(self, renderer, camera):
        unknown = np.isnan(camera)
        self.renderer, self.camera = np.where(unknown, np.nan, renderer), np.where(unknown, np.nan, camera)
        self.total = self.renderer + self.camera

    def only(self, frames):
        """The errors in these frames; NaN in the others."""
        return ContactErrors(self.renderer, np.where(frames, self.camera, np.nan))


def contact_errors(contacts_W, windows, scene, captured_s):
    """contacts_W: windows x runs x frames x 3. Returns the errors of each run on each window. Each frame is read once."""
    renderer, total = np.empty((2, *contacts_W.shape[:-1]))
    for frame, time_s in enumerate(captured_s):
        for i, window in enumerate(windows):
            at_W = contacts_W[i, :, frame]
            renderer[i, :, frame] = window.clouds[frame].surface_distances(at_W, MEASURED_RADIUS_M)
            total[i, :, frame] = scene.signed_distances(at_W, time_s)
    return [[*map(ContactErrors, *of)] for of in zip(renderer, total - renderer)]
