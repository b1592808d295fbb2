"""The speed at which a surface may first touch the proxy: pop-through without noise, at three frame rates.

(4.14) bounds the acceleration of a surface whose velocity the proxy has already estimated. At the first touch the estimate
v_hat is still 0 (4.2.5). The points form a plane that moves along its normal with the speed v, so each frame shows the plane
closer by delta = v / f_c. The proxy is at rest. b is the distance from its centre to the nearest points, measured in the plane,
and d the distance from its centre to the plane. Two values of d matter:
    t = (r_1^2 - b^2)^(1/2): the proxy is entrenched if d < t;
    e = (r_c^2 - b^2)^(1/2): (4.10) moves the proxy to this distance.
The last frame before the touch shows the plane at d, with t <= d < t + delta; the next one at d - delta, which is below t.
  1. If d < delta, the plane is behind the centre. The normal (4.1) has changed its sign, and the proxy is lost.
  2. Otherwise (4.10) moves the proxy by e - (d - delta), and (4.13) sets v_hat / f_c to this step. At the following frame (4.3)
     moves the proxy by the same step before it tests the points, so the plane is at 2 e - d. If d > 2 e, the proxy is lost.
  3. Otherwise (4.13) gives v_hat = v, and the proxy rests at e after each later frame.
If the motion starts at a time that is uniform over one interval between frames, d is uniform too. The two lost intervals of d
are one interval of the start time, because d = t and d = t + delta are the same time. The proxy is lost for a fraction
    (max(0, delta - t) + max(0, delta + t - 2 e)) / delta, at most 1.
No proxy is lost up to v = t f_c. A hand that touches the moving surface between two frames finds it at d = e, so step 1 alone
decides: the proxy is lost above v = e f_c.

Assumption: the estimated normal is that of the plane. It holds over a point and in the middle between points; elsewhere the proxy
slides, and the fraction lies between those of these two positions. r_3 >= 2 r_c, so the proxy has a normal before the touch.
"""
import dataclasses
import json
import sys

import numpy as np

from remote_touch.studies import dots, line, main, study

R1_M, RC_M = 0.00499, 0.005
BETWEEN_POINTS_M, OVER_A_POINT_M = 0.0015 / np.sqrt(2), 0  # b; the points are 1.5 mm apart, as in Table 4.2
FRAME_RATE_HZ = 30  # of the stored sweep
HAND = "a hand presses onto it"


@dataclasses.dataclass
class Touches:
    """The fraction of start times at which the proxy was lost, over the speed of the surface."""
    name: str
    meaning: str
    rate_hz: float
    beside_m: float  # b
    phases: int  # start times for each speed
    speed: np.ndarray = None
    lost: np.ndarray = None

    @property
    def touching_m(self):
        return np.sqrt(R1_M ** 2 - self.beside_m ** 2)  # t

    @property
    def resting_m(self):
        return np.sqrt(RC_M ** 2 - self.beside_m ** 2)  # e

    def derived(self, speed):
        moved_m, t, e = speed / self.rate_hz, self.touching_m, self.resting_m
        return np.minimum(1, (np.maximum(0, moved_m - t) + np.maximum(0, moved_m + t - 2 * e)) / moved_m)


def touches(s, name, meaning, *, rate_hz=FRAME_RATE_HZ, beside_m=BETWEEN_POINTS_M, phases=63, **settings):
    """Makes the stored sweep. At another frame rate the speeds are such that the surface moves the same distances from frame to
    frame, and the start times are again uniform over one interval between frames."""
    speeds = np.array(json.loads((s.folder / "first-touch.json").read_text())["axes"][0]["values"])
    made = s.sweep("first-touch", {"scenario.frame_rate_hz": rate_hz, "axes.0.values": speeds * rate_hz / FRAME_RATE_HZ,
                                   "axes.1.count": phases, "axes.1.to": (phases - 1) / phases / rate_hz, **settings})
    return Touches(name, meaning, rate_hz, beside_m, phases, made.start_velocity_m_per_s.values,
                   made.popped_through.values[:, :, 0].mean(axis=1))


@study("first-touch", "how fast a surface may move when it first touches the proxy, at 15, 30 and 60 frames per second",
       title="Pop-through at the first touch", caption="""
       A surface without noise moves evenly towards a proxy at rest. When it first touches the proxy, the velocity estimate is 0.
       Drawn is the fraction of 63 start times, uniform over one interval between two frames, at which the surface passes the
       proxy (dots), and the derived fraction (lines). Lower panel: a proxy straight over a point, and a hand that presses onto the
       moving surface, so that it touches it between two frames. Simulated.""")
def first_touch(s):
    rates = [touches(s, f"{hz}_hz", f"{hz} Hz", rate_hz=hz) for hz in (15, 30, 60)]
    point = touches(s, "over_point", "over a point", beside_m=OVER_A_POINT_M, **{"scenario.phase_x": 0.5, "scenario.phase_z": 0.5})
    # The hand presses onto the surface while it rises, 5 to 9 cm below the position where the hand waited.
    hand = touches(s, "by_hand", HAND, phases=9, **{"scenario.start_depth_m": 0.1, "trajectory.press_at_s": 0.15})

    for each in rates:
        claim_rate(s, each)
    claim_formula(s, point, "over a point, 30 Hz")
    limit = hand.resting_m * hand.rate_hz
    claims = s.claims("a hand presses onto the moving surface, 30 Hz: ")
    claims.at_most("no proxy is lost up to the speed (r_c^2 - s^2 / 2)^(1/2) f_c: largest fraction lost",
                   hand.lost[hand.speed <= limit].max(), 0, "fraction")
    claims.at_least("every proxy is lost above the speed (r_c^2 - s^2 / 2)^(1/2) f_c: smallest fraction lost",
                    hand.lost[hand.speed > limit].min(), 1, "fraction")

    for each in (*rates, point):
        draw_formula(s, each)
    loss_table(s, "rates", "proxy at rest in the middle of four points", rates)
    loss_table(s, "over_point", "proxy at rest over a point", [point])
    loss_table(s, "by_hand", "a hand presses onto the moving surface", [hand])
    panel(s, "Proxy at rest in the middle of four points", rates, "rates")
    panel(s, "Proxy at rest over a point, and a hand that presses, 30 Hz", [point], "over_point",
          dots("by_hand", "speed", "lost", f"measured, {HAND}"))


def claim_formula(s, each, where):
    """The number of evenly spaced start times in an interval differs from the formula by less than one."""
    s.claims(where).at_most(
        ": a proxy at rest is lost at as many start times as the formula says: largest difference of the fractions",
        np.abs(each.lost - each.derived(each.speed)).max(), 1 / each.phases, "fraction")


def claim_rate(s, each):
    claim_formula(s, each, each.meaning)
    below, derived = each.speed <= each.touching_m * each.rate_hz, each.derived(each.speed)
    s.claims(f"{each.meaning}: ").at_most(
        "no proxy is lost up to the speed (r_1^2 - s^2 / 2)^(1/2) f_c: largest fraction lost",
        each.lost[below].max(), 0, "fraction", "r_1 f_c (4.14)")
    s.claims(f"{each.meaning}: ", set_up=True).at_least(
        "the start time decides at many speeds whether a proxy is lost: number of these speeds",
        ((derived > 0) & (derived < 1)).sum(), 8, "speeds")


def draw_formula(s, each):
    speed = np.arange(80, 221) / 100 * each.touching_m * each.rate_hz
    s.table(f"formula_{each.name}", f"the formula, {each.meaning}", speed=(speed, "m/s", "speed of the surface"),
            lost=(each.derived(speed), "1", "fraction of start times at which the proxy is lost"))


def loss_table(s, name, title, all_touches):
    """A row for each speed of each of the touches."""
    def rows(of):
        return np.concatenate([np.broadcast_to(of(each), each.speed.shape) for each in all_touches])
    s.table(name, title,
            frame_rate=(rows(lambda each: each.rate_hz), "Hz", "f_c"),
            nearest_beside=(rows(lambda each: each.beside_m), "m",
                            "from the proxy's centre to the nearest points, along the surface"),
            speed=(rows(lambda each: each.speed), "m/s", "speed of the surface"),
            lost=(rows(lambda each: each.lost), "1", "fraction of start times at which the proxy was lost"),
            at_rest=(rows(lambda each: each.derived(each.speed)), "1", "fraction that the formula gives for a proxy at rest"))


def panel(s, title, all_touches, table, *more):
    s.panel(title, "speed of the surface (m/s)", "fraction lost",
            [*(line(f"formula_{each.name}", "speed", "lost", f"derived, {each.meaning}") for each in all_touches),
             dots(table, "speed", "lost", "measured, proxy at rest"), *more])


if __name__ == "__main__":
    sys.exit(main())
