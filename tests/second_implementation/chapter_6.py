"""Chapter 6 from its equations: the depth filter of 6.2.1, and a tool turned between walls, 6.3.1.

The tool is turned about the axis along which the walls stand, so the plane across it is enough: the tool is its outline
there, the hull of four discs (core/mesh/generated_meshes.cpp, "husky" and "block"); a motion is two
displacements and a rotation.

Readings, where the print leaves a choice (analysis/theory/README.md has the evidence for each):
- 6.2.2: a point less than a voxel deep in the tool is in contact, a deeper one in collision.
- (6.1): a displacement per unit step. (6.4): the factor 1/2 changes nothing.
- 6.2.5: the motion that is found is limited to s_max; sub-steps are half a voxel.
"""
import itertools
import math

import numpy

VOXEL = 0.5e-3  # sub-steps of half of that are shorter than s_max, 1 mm


# --- 6.2.1: the filter at a step in depth ---

def filtered(depth, focal, sigma, window=9):
    """Weights of a Gaussian in the distance between points."""
    rows, columns = depth.shape
    v, u = numpy.mgrid[0:rows, 0:columns]
    points = numpy.stack([(u - (columns - 1) / 2) / focal * depth, (v - (rows - 1) / 2) / focal * depth, depth])
    half = window // 2
    total, weights = numpy.zeros_like(depth), numpy.zeros_like(depth)
    for down, right in itertools.product(range(-half, half + 1), repeat=2):
        here = (slice(max(0, -down), rows - max(0, down)), slice(max(0, -right), columns - max(0, right)))
        there = (slice(max(0, down), rows + min(0, down)), slice(max(0, right), columns + min(0, right)))
        apart = points[(slice(None), *there)] - points[(slice(None), *here)]
        weight = numpy.exp(-numpy.sum(apart ** 2, axis=0) / (2 * sigma ** 2))
        total[here] += weight * depth[there]
        weights[here] += weight
    return total / weights


def filter_numbers(seed):
    """A step of 25 mm at 0.8 m, 640 x 480 pixels; noise of 1.5 mm. Pixels within 12 of the border or step are left out."""
    truth = numpy.full((480, 640), 0.8)
    truth[:, 320:] += 0.025
    noise = 0.0015 * numpy.random.Generator(numpy.random.PCG64(seed)).standard_normal(truth.shape)
    inner = numpy.zeros(truth.shape, bool)
    inner[12:-12, 12:-12] = True
    walls = inner.copy()
    walls[:, 308:332] = False
    numbers = {}
    for name, sigma in (("wide", 0.025), ("narrow", 0.010)):
        smear = abs(filtered(truth, 525.0, sigma) - truth)[inner].max()
        left = (filtered(truth + noise, 525.0, sigma) - truth)[walls]
        numbers[name] = {"sigma_f_m": sigma, "smear_m": smear, "noise_gain": float(numpy.sqrt(numpy.mean(left ** 2)) / 0.0015)}
    return numbers


# --- 6.3.1: a tool turned between walls ---

DISCS = [((34.75e-3, 24e-3), 10e-3), ((-34.75e-3, 24e-3), 10e-3), ((35.12e-3, -26e-3), 8e-3), ((-35.12e-3, -26e-3), 8e-3)]
BLOCK = [((x, z), 8e-3) for x in (39.5e-3, -39.5e-3) for z in (26e-3, -26e-3)]
BOX = (0.110, 0.090)
DIRECTIONS = numpy.stack([f(numpy.linspace(0, 2 * math.pi, 1440, endpoint=False)) for f in (numpy.cos, numpy.sin)], axis=1)


def reach(discs, direction):
    return max(numpy.dot(centre, direction) + radius for centre, radius in discs)


def stop_angle_deg(discs=DISCS, box=BOX):
    """The smallest rotation at which the outline is as wide as the box. In the middle, it then touches both walls."""
    def is_free(angle):
        c, s = math.cos(angle), math.sin(angle)
        width = reach(discs, (c, s)) + reach(discs, (-c, -s))
        depth = reach(discs, (-s, c)) + reach(discs, (s, -c))
        return width < box[0] and depth < box[1]

    low, high = 0.0, math.radians(45)
    first = next(a for a in numpy.linspace(low, high, 4501) if not is_free(a))
    low, high = first - math.radians(0.01), first
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if is_free(middle) else (low, middle)
    return math.degrees(high)


def walls(spacing, box=BOX):
    """Points and inward normals of the four walls, in the plane."""
    points, normals = [], []
    for axis, (length, other) in enumerate((box, box[::-1])):
        count = int(other / spacing + 1e-9) + 1
        for side in (-1, 1):
            for k in range(count):
                place = [0.0, 0.0]
                place[axis], place[1 - axis] = side * length / 2, (k - (count - 1) / 2) * spacing
                points.append(place)
                normals.append([-side if c == axis else 0 for c in (0, 1)])
    return numpy.array(points), numpy.array(normals, float)


class Tool:
    """Pose x, z and angle. Displacements of the rotation are measured by the largest reach of the outline."""

    def __init__(self, discs=DISCS):
        self.reaches = numpy.array([reach(discs, e) for e in DIRECTIONS])
        self.extent = self.reaches.max()
        self.inertia = (0.110 / 4) ** 2  # per mass, of a body of this size: (6.4) is the same for any positive value at rest
        self.pose = numpy.zeros(3)

    def depth(self, points):
        """How deep each point is in the tool; negative outside."""
        c, s = math.cos(self.pose[2]), math.sin(self.pose[2])
        own = (points - self.pose[:2]) @ numpy.array([[c, -s], [s, c]])
        return (self.reaches - own @ DIRECTIONS.T).min(axis=1)

    def size(self, motion):
        return math.hypot(motion[0], motion[1]) + abs(motion[2]) * self.extent

    def limited(self, motion, most):
        size = self.size(motion)
        return motion * (most / size) if size > most else motion

    def rows(self, points, normals):
        """(6.3): n.a + (r x n) alpha."""
        r = points - self.pose[:2]
        return numpy.column_stack([normals, r[:, 0] * normals[:, 1] - r[:, 1] * normals[:, 0]])

    def nearest_motion(self, wanted, rows, least):
        """(6.4), (6.5) or (6.7), (6.8): the motion nearest to the wanted one with rows.motion >= least, by trying the sets
        of rows that may hold it. Where no motion does, none."""
        scale = numpy.array([1, 1, math.sqrt(self.inertia)])
        a, goal = rows / scale, wanted * scale
        best = None
        for count in range(4):
            for held in itertools.combinations(range(len(a)), count):
                if count == 0:
                    y = goal
                else:
                    b = a[list(held)]
                    if numpy.linalg.matrix_rank(b, 1e-9) < count:
                        continue
                    y = goal + numpy.linalg.pinv(b) @ (least - b @ goal)
                if (a @ y >= least - 1e-9).all():
                    cost = numpy.sum((y - goal) ** 2)
                    if best is None or cost < best[0]:
                        best = cost, y
        return numpy.zeros(3) if best is None else best[1] / scale


def extremes(rows):
    """At most a few of many rows: those of one wall differ only in their lever, and the ends of its range hold the rest."""
    kept = {}
    for row in rows:
        side = tuple(row[:2])
        low, high = kept.get(side, (row, row))
        kept[side] = (row if row[2] < low[2] else low, row if row[2] > high[2] else high)
    return numpy.unique(numpy.array([row for pair in kept.values() for row in pair]), axis=0)


def plateau_deg(spacing, discs=DISCS, free_deg=15.0, commanded_deg=30.0, degrees_a_tick=0.05, detections=60):
    """6.2.5 while the device turns on from a rotation at which nothing touches; the rotation of the tool at its end."""
    points, normals = walls(spacing)
    tool = Tool(discs)
    tool.pose[2] = math.radians(free_deg)
    if (tool.depth(points) > 0).any():
        raise ValueError("the tool touches where it should be free")
    device = numpy.zeros(3)
    for tick in range(int((commanded_deg - free_deg) / degrees_a_tick) + 100):
        device[2] = math.radians(min(commanded_deg, free_deg + (tick + 1) * degrees_a_tick))
        for _ in range(detections):
            depth = tool.depth(points)
            wanted = device - tool.pose
            collides, touches = depth > VOXEL, depth > 0
            if collides.any():
                motion = tool.nearest_motion(numpy.zeros(3), extremes(tool.rows(points, normals)[collides]), 1.0)
                motion = tool.limited(motion, VOXEL / 2)
            elif touches.any():
                motion = tool.nearest_motion(wanted, extremes(tool.rows(points, normals)[touches]), 0.0)
                motion = tool.limited(motion, VOXEL / 2)
            else:
                motion = tool.limited(wanted, VOXEL / 2)
            if tool.size(motion) < 1e-6:
                break
            tool.pose = tool.pose + motion
    return math.degrees(tool.pose[2])


def stop(discs):
    wider = stop_angle_deg(discs, (BOX[0] + 2e-4, BOX[1] + 2e-4))  # every wall 0.1 mm further away
    return {"stop_angle_deg": stop_angle_deg(discs), "deg_per_mm": (wider - stop_angle_deg(discs)) / 0.1}


def box_numbers():
    return {**stop(DISCS), "plateau_deg": {f"{mm} mm": plateau_deg(mm * 1e-3) for mm in (3, 2, 1)},
            "block": {**stop(BLOCK), "plateau_deg": {"3 mm": plateau_deg(3e-3, BLOCK)}}}
