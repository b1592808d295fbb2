"""Chapter 5 from its equations: one proxy among points with forbidden regions, and the crossings of 5.3.2.

Readings, where the print leaves a choice (analysis/theory/README.md has the evidence for each):
- xi of 5.3 is 1/3: (5.13) multiplies it by r_1 once more. (5.7), (5.8): weighted means, without the factor M.
- (5.9): the nearer root of the points ahead, never further than the HIP. A tick that would end in a region goes on
  with (5.11) until it does not.
- A tick has at most 30 steps, fewer where one changes nothing. The HIP is inside where u.n < 0.
- The force is k_s (|u| - r_c) from the last position in contact, until a tick passes in free motion.
"""
import numpy

from chapter_4 import GAMMA, R_1, R_2, R_3, R_C, SPACING, weight

XI = 1 / 3
STEPS, EXIT_STEPS, TICK_S = 30, 10, 1e-3


class Proxy:
    def __init__(self, points, radius, stiffness, start):
        self.points, self.radius, self.stiffness = points, radius, stiffness
        self.p, self.n, self.k_s = numpy.array(start, float), numpy.zeros(3), 0.0
        self.touched = None  # position and stiffness of the last contact
        self.kept = None

    def tick(self, hip):
        """Up to 30 steps; the force."""
        states = []
        for _ in range(STEPS):
            before = self.p
            states.append(self._step(hip))
            if (self.p == before).all():
                break
        for _ in range(EXIT_STEPS):
            if self._nearest() >= R_1:
                break
            self._step(hip)
        if "contact" in states:
            self.touched = True
        elif all(state == "free" for state in states):
            self.touched = None
        stretch = numpy.linalg.norm(hip - self.p) - R_C
        return self.k_s * stretch if self.touched and stretch > 0 else 0.0

    def _local(self):
        """The points whose regions may matter to a proxy up to 5 mm away."""
        if self.kept is None or numpy.linalg.norm(self.p - self.kept[0]) > 5e-3:
            near = numpy.linalg.norm(self.points - self.p, axis=1) - self.radius < R_3 + 10e-3
            self.kept = self.p, self.points[near], self.radius[near], self.stiffness[near]
        return self.kept[1:]

    def _nearest(self):
        points, radius, _ = self._local()
        return (numpy.linalg.norm(points - self.p, axis=1) - radius).min(initial=numpy.inf)

    def _step(self, hip):
        points, radius, stiffness = self._local()
        u = hip - self.p
        distance = numpy.linalg.norm(u)
        to = points - self.p
        length = numpy.linalg.norm(to, axis=1)
        r_n = length - radius  # (5.5)
        psi = weight(r_n)      # (5.6)
        nearest = r_n.min(initial=numpy.inf)
        if psi.sum() > 0:
            total = -(psi / length) @ to  # (5.7)
            if numpy.linalg.norm(total) > 1e-9:
                self.n = total / numpy.linalg.norm(total)
            self.k_s = psi @ stiffness / psi.sum()  # (5.8)
        if nearest > R_2:
            if distance > 0:
                self._free(u, distance)
            return "free"
        if nearest < R_1:  # (5.10), (5.11), (5.15)
            inside = r_n < R_1
            b = to[inside] @ self.n
            square = (radius[inside] + R_C) ** 2 - length[inside] ** 2 + b ** 2
            self.p = self.p + (b + numpy.sqrt(numpy.maximum(0, square))).max() * self.n
            return "entrenched"
        if u @ self.n < 0:  # (5.12), (5.13), (5.16)
            u_p = u - (u @ self.n) * self.n
            size = numpy.linalg.norm(u_p)
            if size > 0:
                self.p = self.p + min(size, GAMMA * size if size <= R_1 else XI * R_1) * u_p / size
        else:
            self.p = self.p + (R_2 - R_1) * self.n  # (5.17)
        return "contact"

    def _free(self, u, distance):
        """(5.9), (5.14), over all points: the way may be long."""
        along = u / distance
        to = self.points - self.p
        b = to @ along
        square = (self.radius + R_C) ** 2 - numpy.sum(to * to, axis=1) + b ** 2
        hits = (b > 0) & (square > 0)
        step = (b[hits] - numpy.sqrt(square[hits])).min(initial=numpy.inf)
        self.p = self.p + step * along if step < distance else self.p + u


def path(waypoints, tick_s=TICK_S):
    """Positions at every tick: [x, y, z, speed of the motion to it]."""
    places, times = [numpy.array(waypoints[0][:3], float)], [0.0]
    for *place, speed in waypoints[1:]:
        places.append(numpy.array(place, float))
        times.append(times[-1] + numpy.linalg.norm(places[-1] - places[-2]) / speed)
    ticks = numpy.arange(0, times[-1] + 1e-9, tick_s)
    return numpy.stack([numpy.interp(ticks, times, [p[c] for p in places]) for c in range(3)], axis=1)


def flat_points(columns=100, rows=100, reach=0.03):
    """A flat grid; what lies further from z = 0 than a proxy there can meet is left out."""
    x, z = numpy.meshgrid((numpy.arange(columns) - (columns - 1) / 2) * SPACING,
                          (numpy.arange(rows) - (rows - 1) / 2) * SPACING)
    points = numpy.stack([x.ravel(), numpy.zeros(x.size), z.ravel()], axis=1)
    return points[abs(points[:, 2]) < reach]


def crossing(height, until_x=0.03):
    """5.3.2: r_f = 0 for x < 0, 0.01 m from there on; the HIP moves along x at a height. Rows x, force, y of the proxy."""
    points = flat_points()
    radius = numpy.where(points[:, 0] >= 0, 0.01, 0.0)
    hips = path([[-0.04, 0.01, 0, 0], [-0.04, height, 0, 0.05], [0.04, height, 0, 0.01]])
    proxy = Proxy(points, radius, numpy.full(len(points), 600.0), hips[0])
    rows = []
    for before, hip in zip(numpy.vstack([hips[:1], hips]), hips):
        force = proxy.tick(hip)
        if hip[0] > before[0]:
            rows.append((hip[0], force, proxy.p[1]))
        if hip[0] > until_x:
            break
    return numpy.array(rows)


def mean_force(rows, low, high):
    return rows[(rows[:, 0] >= low) & (rows[:, 0] <= high), 1].mean()


def crossing_numbers():
    """What is read of Fig 5.6, and of the same 5 mm below the plane."""
    plane, below = crossing(0.0), crossing(-0.005)

    peak, peak_below = plane[:, 1].argmax(), below[:, 1].argmax()
    return {"force_begins_m": plane[(plane[:, 1] > 0.01).argmax(), 0],
            "max_force_N": plane[peak, 1],
            "max_force_at_m": plane[peak, 0],
            "on_fixture_at_m": plane[(plane[:, 2] >= 0.99 * (0.01 + R_C)).argmax(), 0],
            "force_on_fixture_N": mean_force(plane, 0.02, 0.03),
            "below_force_before_N": mean_force(below, -0.035, -0.025),
            "below_max_force_N": below[peak_below, 1],
            "below_pops_up_at_m": below[peak_below, 0],
            "below_force_on_fixture_N": mean_force(below, 0.02, 0.03)}


def single_point():
    """5.3.1: the smallest distance of the proxy to the one point, at the end of any tick."""
    hips = path([[-0.03, 0.15, 0.01, 0], [-0.02, 0.04, 0.015, 0.05], [0.05, 0.02, -0.02, 0.05], [0.09, 0.07, 0, 0.05],
                 [0.16, 0.02, 0.02, 0.05], [0.06, -0.05, 0.04, 0.05], [0.05, -0.14, 0.02, 0.05]])
    proxy = Proxy(numpy.zeros((1, 3)), numpy.array([0.1]), numpy.array([600.0]), hips[0])
    least = numpy.inf
    for hip in hips:
        proxy.tick(hip)
        least = min(least, numpy.linalg.norm(proxy.p))
    return {"least_distance_m": least}
