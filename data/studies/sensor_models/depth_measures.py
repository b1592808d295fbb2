"""Statistics of the errors of depth images, rows x columns of depths in m, NaN at holes: noise, steps of depth, and holes beside
depth edges. They use the images alone, so that simulated and real sensors are measured by one code.

Sensors that triangulate measure the inverse depth 1 / z: a disparity is focal length times baseline times 1 / z. Therefore noise
and steps are those of the inverse depth, in 1/m. Times z^2 they are metres of depth.
"""
import collections
import math

import numpy as np

WINDOW_PX = 20
FEWEST_SAMPLES, FEWEST_DEPTHS = 20, 10
MIN_JUMP_PER_M = 0.1
LARGEST_STEP = 2  # unit: the median step

# Windows of an image with the planes nearest to them: planes are linear in 1 / z over the pixels. Arrays of rows x columns of
# windows, NaN for a window with holes: inverse depth in its middle, its change from pixel to pixel, and the rms of the pixels about
# the plane.
Windows = collections.namedtuple("Windows", "inverse_per_m across_per_m down_per_m rms_per_m")


class Measured:
    """Statistics of frames. planes: the images in which planes are fitted. Noise over time is that of a scene at rest."""

    def __init__(self, frames, is_at_rest, planes):
        self.depths_m = np.unique(frames)
        self.over_time = temporal_noise(frames) if is_at_rest else None
        windows = np.concatenate([np.reshape(fitted_windows(image), (4, -1)) for image in planes], axis=1)
        self.about_planes = 1 / windows[0], windows[3]
        self.is_left_of_near, self.jump_per_m, self.hole_px = np.concatenate([depth_edges(image) for image in frames], axis=1)

    def noise_over_time(self, near_m, far_m, share):
        return noise_quantile(*self.over_time, near_m, far_m, share)

    def noise_about_planes(self, near_m, far_m, share):
        return noise_quantile(*self.about_planes, near_m, far_m, share)

    def holes_px(self, is_left_of_near, low_per_m, high_per_m):
        """The widths of the holes at the edges on one side of near surfaces with a jump in a range."""
        chosen = (low_per_m <= self.jump_per_m) & (self.jump_per_m < high_per_m)
        return self.hole_px[chosen & (self.is_left_of_near == is_left_of_near)]


def upper_quantile(values, share):
    """A value of the sample, without interpolation."""
    return np.sort(values)[int(share * len(values))]


def upper_median(values, fewest=1):
    return upper_quantile(values, 0.5) if len(values) >= fewest else math.nan


def temporal_noise(frames):
    """The noise over time of each pixel that every frame measured: its depth, and the standard deviation of its 1 / z."""
    depth_m = np.mean(frames, axis=0).ravel()
    return depth_m, np.std(1 / np.array(frames), axis=0, ddof=1).ravel()


def fitted_windows(image):
    """The planes of squares of WINDOW_PX pixels, from the first pixel on. Their columns and rows, counted from the middle, are
    orthogonal to each other and to 1, so that each coefficient is a mean by itself."""
    rows, columns = np.floor_divide(image.shape, WINDOW_PX)
    inverse = 1 / image[:rows * WINDOW_PX, :columns * WINDOW_PX].reshape(rows, WINDOW_PX, columns, WINDOW_PX).swapaxes(1, 2)
    across, down = from_middle()
    variance = (WINDOW_PX**2 - 1) / 12
    middle, slope_across, slope_down = ((inverse * weight).mean(axis=(2, 3)) for weight in (1, across / variance, down / variance))
    wide = middle[..., None, None], slope_across[..., None, None], slope_down[..., None, None]
    residuals = inverse - wide[0] - wide[1] * across - wide[2] * down
    return Windows(middle, slope_across, slope_down, np.sqrt((residuals**2).sum(axis=(2, 3)) / (WINDOW_PX**2 - 3)))


def from_middle():
    """Columns and rows of the pixels of a window, counted from its middle."""
    places = np.arange(WINDOW_PX) - 0.5 * (WINDOW_PX - 1)
    return places[None, :], places[:, None]


def noise_quantile(depth_m, per_m, near_m, far_m, share):
    """The noise that the given share of the samples in a range of depth does not exceed, after the mean of their depths. NaN if
    there are too few samples."""
    chosen = (near_m <= depth_m) & (depth_m < far_m)
    if chosen.sum() < FEWEST_SAMPLES:
        return math.nan, math.nan
    return depth_m[chosen].mean(), upper_quantile(per_m[chosen], share)


def depth_step_per_m(depths_m, near_m, far_m):
    """The step of 1 / z between the depths in a range that occur, increasing: the mean over the steps that are at most twice the
    median step, because depths that no pixel shows leave gaps. NaN if few depths occur."""
    depths_m = depths_m[(near_m <= depths_m) & (depths_m < far_m)]
    if len(depths_m) < FEWEST_DEPTHS:
        return math.nan
    steps = -np.diff(1 / depths_m)
    return steps[steps <= LARGEST_STEP * upper_median(steps)].mean()


def depth_edges(image):
    """Successive measured pixels of a row with a jump of 1 / z of MIN_JUMP_PER_M or more: whether the nearer one is on the right,
    the jump, and the number of holes between them."""
    rows, columns = np.nonzero(image > 0)
    jump_per_m = np.diff(1 / image[rows, columns])
    chosen = (np.diff(rows) == 0) & (np.abs(jump_per_m) >= MIN_JUMP_PER_M)
    return np.array([jump_per_m[chosen] > 0, np.abs(jump_per_m[chosen]), np.diff(columns)[chosen] - 1])


def filled(image):
    """The image with a depth also in its holes: the farther one of the depths that end a hole on the left and on the right in its
    row, because shadows of a sensor lie on far surfaces. Holes at the border of the image remain."""
    columns, width = np.arange(image.shape[1]), image.shape[1]
    last = np.maximum.accumulate(np.where(np.isnan(image), -1, columns), axis=1)
    following = np.minimum.accumulate(np.where(np.isnan(image), width, columns)[:, ::-1], axis=1)[:, ::-1]
    ends_m = [np.take_along_axis(image, at.clip(0, width - 1), axis=1) for at in (last, following)]
    return np.where((last >= 0) & (following < width), np.maximum(*ends_m), np.nan)


def planar_scene(windows, camera):
    """The depths of the fitted planes, and the cosines between the rays of the pixels and the planes' normals. The plane
    1 / z = a u + b v + c has the normal (a fx, b fy, a cx + b cy + c), whose product with the ray ((u - cx) / fx, (v - cy) / fy, 1)
    is 1 / z. There is nothing where no plane was fitted."""
    rows, columns = windows.inverse_per_m.shape
    inverse, a, b = (of[..., None, None] for of in windows[:3])
    across, down = from_middle()
    v, u = np.mgrid[:rows * WINDOW_PX, :columns * WINDOW_PX]
    ray_x, ray_y = (in_windows(pixels) for pixels in ((u - camera["cx"]) / camera["fx"], (v - camera["cy"]) / camera["fy"]))
    middle_u, middle_v = (in_windows(pixels)[..., :1, :1] + 0.5 * (WINDOW_PX - 1) for pixels in (u, v))
    at_centre = inverse + a * (camera["cx"] - middle_u) + b * (camera["cy"] - middle_v)
    normal_x, normal_y = a * camera["fx"], b * camera["fy"]
    product = normal_x * ray_x + normal_y * ray_y + at_centre
    lengths = np.sqrt((normal_x**2 + normal_y**2 + at_centre**2) * (ray_x**2 + ray_y**2 + 1))
    depth, cosine = np.full((2, camera["height"], camera["width"]), [[[np.nan]], [[1.0]]])
    whole = np.s_[:rows * WINDOW_PX, :columns * WINDOW_PX]
    depth[whole] = (1 / (inverse + a * across + b * down)).swapaxes(1, 2).reshape(depth[whole].shape)
    cosine[whole] = (np.abs(product) / lengths).swapaxes(1, 2).reshape(cosine[whole].shape)
    cosine[np.isnan(depth)] = 1
    return depth, cosine


def in_windows(pixels):
    """The pixels of an image of whole windows, as rows and columns of windows."""
    return pixels.reshape(-1, WINDOW_PX, pixels.shape[1] // WINDOW_PX, WINDOW_PX).swapaxes(1, 2)
