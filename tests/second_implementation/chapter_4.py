"""Chapter 4 from its equations: the proxy of 4.2 on many clouds at once, and the lifts of 4.3.2.

Readings, where the print leaves a choice (analysis/theory/README.md has the evidence for each):
- (4.3) uses the estimate and the normal from before the update; (4.13) then takes the first step, whatever the state.
- (4.9): the nearer root of the points ahead, never further than the HIP.
- (4.7): the length of (4.11) and (4.12), with u in place of its projection.
- The HIP is inside where u.n < 0. Without points in r_3 the last normal stays.
- Pop-through: the centre of the proxy is below the true plane, one frame after the last update.
Steps stop where one changes nothing, because then no later one does.
"""
import numpy

R_C = 5e-3
R_1, R_2, R_3 = R_C - 1e-5, R_C + 1e-5, 2 * R_C
GAMMA, XI = 0.3, 0.1
SPACING, FRAME_RATE = 0.3 * R_C, 30
NEAR = R_3 + 0.4 * R_C  # of a point that is kept at hand
FAR = 1e3               # where there is no point


def weight(r):
    """(4.2)"""
    t = numpy.clip((r - R_1) / (R_3 - R_1), 0, 1)
    square = numpy.square(1 - t)
    return square * square * (4 * t + 1)


class Proxies:
    """L proxies, each in a cloud of its own."""

    def __init__(self, start, velocity_estimate=True, fixed_step=None):
        self.p = numpy.array(start, float)
        self.n = numpy.zeros_like(self.p)
        self.v = numpy.zeros(len(self.p))
        self.velocity_estimate, self.fixed_step = velocity_estimate, fixed_step
        self.error_sum = numpy.zeros(len(self.p))  # of 1 - n_y over the steps of a frame, and their number
        self.steps = numpy.zeros(len(self.p))

    def frame(self, clouds, hip, steps):
        """A new cloud for each, and so many steps towards a HIP at rest."""
        self.clouds, self.hip = clouds, hip
        if self.velocity_estimate:
            self.p += (self.v / FRAME_RATE)[:, None] * self.n  # (4.3)
        before, first = self.n.copy(), self.p.copy()
        count = len(self.p)
        self.centre, self.at_hand = self.p.copy(), numpy.full((count, 3, 8), FAR)
        self._gather(numpy.arange(count))
        self.error_sum[:], self.steps[:] = 0, 0
        moving = numpy.arange(count)
        for k in range(steps):
            left = numpy.linalg.norm(self.p[moving] - self.centre[moving], axis=1) > NEAR - R_3
            if left.any():
                self.centre[moving[left]] = self.p[moving[left]]
                self._gather(moving[left])
            at = self.p[moving]
            self.p[moving] = self._step(moving)
            self.error_sum[moving] += 1 - self.n[moving, 1]
            self.steps[moving] += 1
            if k == 0 and self.velocity_estimate:  # (4.13)
                self.v = numpy.maximum(0, self.v + FRAME_RATE * numpy.sum(before * (self.p - first), axis=1))
            moving = moving[(self.p[moving] != at).any(axis=1)]
            if not len(moving):
                break

    def mean_normal_error(self, steps):
        """(4.22), the mean over all steps of the frame, also of those after the last that moved."""
        rest = steps - self.steps
        return (self.error_sum + rest * (1 - self.n[:, 1])) / steps

    def _gather(self, which):
        """Puts the points near the centres at hand."""
        near = [cloud[:, numpy.sum((cloud - self.centre[i][:, None]) ** 2, axis=0) < NEAR ** 2]
                for i, cloud in ((i, self.clouds[i]) for i in which)]
        longest = max(points.shape[1] for points in near)
        if longest > self.at_hand.shape[2]:
            wider = numpy.full((len(self.p), 3, longest + 16), FAR)
            wider[:, :, :self.at_hand.shape[2]] = self.at_hand
            self.at_hand = wider
        self.at_hand[which] = FAR
        for i, points in zip(which, near):
            self.at_hand[i, :, :points.shape[1]] = points

    def _step(self, which):
        """Where one step leads each of them to; sets their normals."""
        p, u = self.p[which], self.hip[which] - self.p[which]
        to = (self.at_hand if len(which) == len(self.p) else self.at_hand[which]) - p[:, :, None]
        r = numpy.sqrt(numpy.einsum("lck,lck->lk", to, to))
        nearest = r.min(axis=1)
        share = weight(r) / numpy.maximum(r, 1e-300)
        total = -numpy.einsum("lck,lk->lc", to, share)  # (4.1)
        length = numpy.linalg.norm(total, axis=1)
        seen = length > 1e-9
        self.n[which[seen]] = total[seen] / length[seen, None]
        n = self.n[which]
        distance = numpy.linalg.norm(u, axis=1)
        along = u / numpy.maximum(distance, 1e-300)[:, None]
        free, entrenched = nearest > R_2, nearest < R_1
        contact = ~free & ~entrenched
        inside = contact & (numpy.sum(u * n, axis=1) < 0)
        step = numpy.zeros_like(p)
        rows = numpy.flatnonzero(free & (distance > 0))
        if len(rows):
            step[rows] = self._free_lengths(which[rows], to[rows], along[rows], distance[rows])[:, None] * along[rows]
        rows = numpy.flatnonzero(entrenched)
        if len(rows):  # (4.5), (4.10)
            b = numpy.einsum("lck,lc->lk", to[rows], n[rows])
            root = b + numpy.sqrt(numpy.maximum(0, R_C ** 2 - r[rows] ** 2 + b ** 2))
            lengths = numpy.where(r[rows] < R_1, root, 0).max(axis=1)
            step[rows] = self._length(lengths)[:, None] * n[rows]
        goal = numpy.where(inside[:, None], u - numpy.sum(u * n, axis=1)[:, None] * n, u)
        size = numpy.linalg.norm(goal, axis=1)
        lengths = self._length(numpy.where(size < R_1, GAMMA * size, XI * R_1))  # (4.11), (4.12)
        rows = contact & (size > 0)
        step[rows] = (numpy.minimum(lengths, size) / numpy.maximum(size, 1e-300))[rows, None] * goal[rows]  # (4.6), (4.7)
        arrives = free & numpy.isclose(numpy.linalg.norm(step, axis=1), distance, rtol=1e-15, atol=0)
        return numpy.where(arrives[:, None], self.hip[which], p + step)

    def _length(self, lengths):
        return lengths if self.fixed_step is None else numpy.full_like(lengths, self.fixed_step)

    def _free_lengths(self, which, to, along, distance):
        """(4.9)"""
        lengths = free_length(to, along, distance)
        # Beyond what is at hand another point may be in the way.
        beyond = numpy.linalg.norm(self.p[which] - self.centre[which], axis=1) + lengths + R_C > NEAR
        for row in numpy.flatnonzero(beyond):
            cloud = self.clouds[which[row]] - self.p[which[row]][:, None]
            lengths[row] = free_length(cloud[None], along[row][None], distance[row][None])[0]
        if self.fixed_step is not None:
            lengths = numpy.minimum(lengths, self.fixed_step)
        return lengths


def free_length(to, along, distance):
    b = numpy.einsum("lck,lc->lk", to, along)
    aside = numpy.einsum("lck,lck->lk", to, to) - b ** 2
    hits = (b > 0) & (aside < R_C ** 2)
    root = numpy.where(hits, b - numpy.sqrt(numpy.where(hits, R_C ** 2 - aside, 0)), numpy.inf)
    return numpy.minimum(root.min(axis=1), distance)


# --- 4.3.2: lifts ---

GRID = 200
RISE_FRAMES, START_VELOCITY, HIP_DEPTH = 15, 0.1, 6 * R_C
KEPT = 0.04  # points this much further from the axis of the lift than the proxy are left out


def noisy_cloud(random, height, sigma, phase=(0, 0), kept=KEPT):
    """A flat 200 x 200 grid with noise on every coordinate, 4.3.2; what may matter of it."""
    line = (numpy.arange(GRID) - (GRID - 1) / 2) * SPACING
    reach = kept + 5 * sigma
    x, z = (a.ravel() for a in numpy.meshgrid(line[abs(line) < reach] + phase[0] * SPACING,
                                              line[abs(line) < reach] + phase[1] * SPACING))
    points = numpy.stack([x, numpy.full_like(x, height), z])
    if sigma > 0:
        points += sigma * random.standard_normal(points.shape)
    return points[:, points[0] ** 2 + points[2] ** 2 < kept ** 2]


def plane_heights(acceleration, updates, start_velocity=START_VELOCITY, rise=RISE_FRAMES):
    """Of every frame: [frame][lift]. The rise ends at the origin."""
    acceleration = numpy.asarray(acceleration, float)
    velocity = numpy.full_like(acceleration, start_velocity)
    heights = [-start_velocity * (rise - j) / FRAME_RATE + 0 * acceleration for j in range(rise + 1)]
    for _ in range(updates):
        velocity = velocity + acceleration / FRAME_RATE
        heights.append(heights[-1] + velocity / FRAME_RATE)
    return heights


def lift(seed, sigma, acceleration, updates=10, steps=1000, velocity_estimate=True, phases=None, fixed_step=None,
         start_velocity=START_VELOCITY, rise=RISE_FRAMES, at_frame_end=None):
    """Whether each lift popped through. seed: one for all; sigma, acceleration: one for each."""
    sigma = numpy.asarray(sigma, float)
    count = len(sigma)
    streams = [numpy.random.Generator(numpy.random.PCG64(s)) for s in numpy.random.SeedSequence(seed).spawn(count)]
    phases = [(0, 0)] * count if phases is None else phases
    proxies = Proxies(numpy.zeros((count, 3)), velocity_estimate, fixed_step)
    for frame, height in enumerate(plane_heights(acceleration, updates, start_velocity, rise)):
        aside = numpy.hypot(proxies.p[:, 0], proxies.p[:, 2])
        kept = KEPT + aside + proxies.v / FRAME_RATE
        clouds = [noisy_cloud(streams[i], height[i], sigma[i], phases[i], kept[i]) for i in range(count)]
        hip = numpy.zeros((count, 3))
        if frame >= rise:
            hip[:, 1] = height - HIP_DEPTH
        proxies.frame(clouds, hip, steps)
        if (numpy.hypot(proxies.p[:, 0], proxies.p[:, 2]) > kept - R_3).any():
            raise RuntimeError("a proxy came to the end of the points that are kept")
        if at_frame_end:
            at_frame_end(frame, height, proxies)
    return proxies.p[:, 1] < height


# --- 4.4: what noise does to a lift without acceleration ---

def steady_lifts(seed, sigma, count, steps=1000, updates=40):
    """h of (4.17) and e_n of (4.22) for each lift: means over its updates from the sixth after the rise on; e_n just before
    an update, and as the mean over all steps of a frame."""
    values = {"h": [], "e_n": [], "e_n_mean": []}

    def note(frame, height, proxies):
        if frame < RISE_FRAMES + 5 or frame == RISE_FRAMES + updates:
            return
        above = proxies.p[:, 1] > height
        values["h"].append(numpy.where(above, proxies.p[:, 1] - height - R_1, numpy.nan))
        values["e_n"].append(numpy.where(above, 1 - proxies.n[:, 1], numpy.nan))
        values["e_n_mean"].append(numpy.where(above, proxies.mean_normal_error(steps), numpy.nan))

    lift(seed, [sigma] * count, [0.0] * count, updates, steps, at_frame_end=note)
    known = numpy.sum(~numpy.isnan(values["h"]), axis=0)
    with numpy.errstate(invalid="ignore"):  # NaN where a lift popped through before
        return {name: numpy.nansum(rows, axis=0) / known for name, rows in values.items()}
