"""A small renderer of points, triangles and line segments: a depth buffer over pixel fragments, in numpy.

Positions are metres in the world frame; a camera sees them in perspective. Colours are 0 to 1.
"""
import dataclasses

import numpy as np

BACKGROUND = 0.965
LIGHT, FILL = np.array([-0.35, -0.55, -0.76]), np.array([0.75, 0.1, -0.65])  # camera frame: towards the lights
FRAGMENTS = 2_000_000  # of triangles at once


@dataclasses.dataclass
class Camera:
    eye: np.ndarray
    target: np.ndarray
    up: np.ndarray
    width_m: float  # seen at the target, across the picture

    def view(self, points, size):
        """x right, y down in pixels, and the depth in metres. size: width and height in pixels."""
        at = (points - self.eye) @ self.axes().T
        depth = np.maximum(at[:, 2], 1e-6)
        scale = self.pixels(size)
        return scale * at[:, 0] / depth + size[0] / 2, scale * at[:, 1] / depth + size[1] / 2, at[:, 2]

    def axes(self):
        """Rows: right, down, forward."""
        forward = unit(self.target - self.eye)
        right = unit(np.cross(forward, self.up))
        return np.array([right, np.cross(forward, right), forward])

    def pixels(self, size):
        """Pixels that a metre spans at a depth of 1 m."""
        return size[0] / self.width_m * np.linalg.norm(self.target - self.eye)


class Canvas:
    def __init__(self, camera, size):
        self.camera, self.size = camera, size
        self.colour = np.full((size[0] * size[1], 3), BACKGROUND)
        self.depth = np.full(size[0] * size[1], np.inf)
        self.solid = np.full(size[0] * size[1], np.inf)  # depth of solids alone

    def points(self, positions, colours, diameter_m, normals=None):
        """Discs that face the camera, darker to their rim; with normals they are shaded."""
        seen = np.isfinite(positions).all(axis=1)
        positions, colours = positions[seen], colours[seen]
        if normals is not None:
            colours = shade(colours, normals[seen] @ self.camera.axes().T, 0.62)
        u, v, z = self.camera.view(positions, self.size)
        radius = np.clip(0.5 * diameter_m * self.camera.pixels(self.size) / np.maximum(z, 1e-6), 0.5, 18)
        radius = np.round(2 * radius) / 2
        for r in np.unique(radius):
            chosen = np.flatnonzero(radius == r)
            du, dv = disc(r)
            rim = 1 - 0.18 * (du**2 + dv**2) / max(r * r, 1)
            depth = np.broadcast_to(z[chosen, None], (chosen.size, du.size))
            self.put(u[chosen, None] + du, v[chosen, None] + dv, depth, colours[chosen, None] * rim[None, :, None])

    def segments(self, begin, end, colour, width_px=2):
        """Lines, from fragments half a pixel apart."""
        ends = [self.camera.view(p, self.size) for p in (begin, end)]
        length = np.hypot(ends[1][0] - ends[0][0], ends[1][1] - ends[0][1])
        along = np.linspace(0, 1, max(2, int(2 * np.nanmax(length, initial=1))))
        u, v, z = (a[:, None] + along * (b - a)[:, None] for a, b in zip(*ends))
        du, dv = disc(width_px / 2)
        for i in range(du.size):
            self.put(u + du[i], v + dv[i], z - 5e-4, np.broadcast_to(colour, u.shape + (3,)))

    def mesh(self, vertices, triangles, colour, opacity=1.0):
        """Smooth-shaded. What is not opaque has an outline, and shows faintly through points that hide it."""
        layer = Canvas(self.camera, self.size)
        layer.surface(vertices, triangles, colour)
        there = np.isfinite(layer.depth)
        if opacity >= 1:
            there &= layer.depth < self.depth
            self.colour[there], self.depth[there] = layer.colour[there], layer.depth[there]
            self.solid = np.minimum(self.solid, layer.depth)
            return
        layer.colour[outline(there, self.size)] = 0.6 * np.asarray(colour)
        share = np.where(layer.depth < self.depth, opacity, 0.5 * opacity * (layer.depth < self.solid))
        share = np.where(outline(there, self.size), np.minimum(2 * share, 1), share)[there, None]
        self.colour[there] = (1 - share) * self.colour[there] + share * layer.colour[there]

    def surface(self, vertices, triangles, colour):
        """Of a closed mesh; what is behind its front cannot be seen, and is not drawn."""
        normals = vertex_normals(vertices, triangles) @ self.camera.axes().T
        colours = shade(np.broadcast_to(colour, vertices.shape), normals, 0.45)
        corner = np.stack(self.camera.view(vertices, self.size), axis=-1)[triangles]
        (u0, v0), (u1, v1), (u2, v2) = (corner[:, i, :2].T for i in range(3))
        area = (u1 - u0) * (v2 - v0) - (u2 - u0) * (v1 - v0)
        low, high = (np.minimum, np.maximum)
        first = np.floor(np.stack([low(low(u0, u1), u2), low(low(v0, v1), v2)], axis=-1))
        last = np.ceil(np.stack([high(high(u0, u1), u2), high(high(v0, v1), v2)], axis=-1))
        span = high(*(last - first).T)
        seen = (area * turning(vertices, triangles) > 0) & (span < 4 * max(self.size))
        for i in range(3):
            seen &= corner[:, i, 2] > 0
        level = np.where(seen, np.ceil(np.log2(high(span, 1))), -1).astype(int)
        for each in np.unique(level[level >= 0]):
            chosen = np.flatnonzero(level == each)
            side = 2**each + 1
            for part in np.array_split(chosen, 1 + chosen.size * side * side // FRAGMENTS):
                self.fill(corner[part], area[part], first[part], colours[triangles[part]], side)

    def fill(self, corner, area, first, colours, side):
        """Triangles that fit into a square of pixels, side by side."""
        across, down = (grid.ravel() for grid in np.meshgrid(np.arange(side), np.arange(side)))
        (u0, v0, z0), (u1, v1, z1), (u2, v2, z2) = (corner[:, i].T for i in range(3))
        u, v = (first - corner[:, 0, :2]).T  # of the first pixel from the first corner
        # Weights of the second and third corner: they grow evenly across and down.
        b = [((v2 - v0) * u - (u2 - u0) * v) / area, (v2 - v0) / area, (u0 - u2) / area]
        c = [((u1 - u0) * v - (v1 - v0) * u) / area, (v0 - v1) / area, (u1 - u0) / area]
        b, c = (at[:, None] + right[:, None] * across + below[:, None] * down for at, right, below in (b, c))
        i, j = np.nonzero((b >= -1e-6) & (c >= -1e-6) & (b + c <= 1 + 1e-6))
        b, c = b[i, j], c[i, j]
        weights = [(1 - b - c) / z0[i], b / z1[i], c / z2[i]]
        depth = 1 / (weights[0] + weights[1] + weights[2])
        shades = sum((weight * depth)[:, None] * colours[i, k] for k, weight in enumerate(weights))
        self.put(first[i, 0] + across[j], first[i, 1] + down[j], depth, shades)

    def put(self, u, v, depth, colours):
        """Fragments: at each pixel the nearest wins."""
        u, v = (np.floor(a + 0.5).astype(np.int64).ravel() for a in (u, v))
        depth, colours = np.ravel(depth), np.reshape(colours, (-1, 3))
        fits = np.flatnonzero((u >= 0) & (v >= 0) & (u < self.size[0]) & (v < self.size[1]) & (depth > 0))
        fits = fits[np.argsort(-depth[fits], kind="stable")]  # of equal pixels the last assignment stays
        pixel = v[fits] * self.size[0] + u[fits]
        winner = np.full(self.depth.size, -1)
        winner[pixel] = fits
        pixel = np.flatnonzero(winner >= 0)
        pixel = pixel[depth[winner[pixel]] < self.depth[pixel]]
        self.depth[pixel], self.colour[pixel] = depth[winner[pixel]], colours[winner[pixel]]

    def image(self, coarser):
        """The picture, with as many pixels averaged along each side."""
        width, height = (n // coarser * coarser for n in self.size)
        pixels = self.colour.reshape(self.size[1], self.size[0], 3)
        mean = sum(pixels[down:height:coarser, right:width:coarser] for down in range(coarser) for right in range(coarser))
        return np.clip(mean / coarser**2, 0, 1)


def unit(vector):
    return vector / np.linalg.norm(vector)


def outline(there, size, width=3):
    """The pixels of a shape that lie so close to its border."""
    grid = np.pad(there.reshape(size[1], size[0]), width)
    inside = grid.copy()
    for shift in (-width, width):
        inside &= np.roll(grid, shift, axis=0) & np.roll(grid, shift, axis=1)
    return (grid & ~inside)[width:-width, width:-width].ravel()


def disc(radius):
    reach = int(np.ceil(radius))
    du, dv = (grid.ravel() for grid in np.meshgrid(*[np.arange(-reach, reach + 1)] * 2))
    inside = du**2 + dv**2 <= max(radius, 0.5)**2
    return du[inside], dv[inside]


def vertex_normals(vertices, triangles):
    """Means of the faces at a vertex, weighted with their areas."""
    a, b, c = (vertices[triangles[:, i]] for i in range(3))
    faces = np.cross(b - a, c - a)
    sums = np.stack([np.bincount(triangles.ravel(), np.repeat(faces[:, i], 3), len(vertices)) for i in range(3)],
                    axis=-1)
    return sums / np.maximum(np.linalg.norm(sums, axis=1, keepdims=True), 1e-30)


def turning(vertices, triangles):
    """The sign that the area of a closed mesh's triangle has in a picture, y down, where its front is seen."""
    a, b, c = (vertices[triangles[:, i]] for i in range(3))
    return -np.sign((np.cross(a, b) * c).sum())


def shade(colours, normals, ambient):
    """normals: in the camera frame; turned to the camera where they point away. NaN: only ambient light."""
    normals = np.nan_to_num(np.where(normals[:, 2:] > 0, -normals, normals))
    light = np.maximum(normals @ unit(LIGHT), 0) + 0.35 * np.maximum(normals @ unit(FILL), 0)
    return colours * (ambient + (1.05 - ambient) * light)[:, None]
