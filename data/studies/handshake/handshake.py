"""The remote handshake of 1.1: a hand that shakes is touched, and moves the hand that touches it."""
import collections
import math
import sys

import numpy as np

import remote_touch as rt
from remote_touch import theory
from remote_touch.studies import dashed, line, main, study

# The shake of the experiment `handshake`: three periods of a sine, as straight pieces. The second and third are used where a hand
# with mass must have settled.
SHAKE_HZ, SHAKES_S, RESTS_S, FRAMES_HZ = 1.5, 0.5, 2.5, 30
SETTLED_S = SHAKES_S + 1 / SHAKE_HZ
HELD_S = 0.45  # the HIP has pressed, and the hand still rests
HIGHEST_S, LOWEST_S = SHAKES_S + 0.25 / SHAKE_HZ, SHAKES_S + 0.75 / SHAKE_HZ
DEEPER_M = 0.012  # by which the passive hand wants to be deeper than the HIP that presses
FROM_ABOVE_M, REACHING_M_PER_S = 0.05, 0.25
CONTACT_RADIUS_M = 0.005
PALM_M = 0.03  # the palm is within this distance of the HIP at rest
STRIDE = 2  # ticks, in tables
SHOWN_S = (0.3, 2.8)
EXACT_SENSOR = {"scenario.noise_px": 0, "scenario.disparity_step_px": 0, "scenario.lateral_noise_px": 0}
UP = np.array([0, 1, 0])

CAPTION = """shakes up and down by 3 cm, three times in 2 s, before a simulated Kinect at half of its resolution. First the HIP
    presses 10 mm into the palm, as the newest frame shows it. Between two frames the proxy stays where it is and the hand moves on:
    this is most of the gap between the proxy's ball and the true hand. Against the hand at the capture of the newest frame the gap
    is the error of the sensor; with a sensor without noise and rounding it is that of the renderer alone. Below: a simulated hand
    with mass wants to stay at a position in the palm, and is shaken."""

# Signed distances from the ball of the proxy to the true surface, positive outside: as it is in a tick, and as it was when the
# frame in use was captured. NaN in ticks in which the surface does not hold the proxy back.
Gaps = collections.namedtuple("Gaps", "now at_capture")
Sinusoid = collections.namedtuple("Sinusoid", "amplitude phase_rad")


def tick_of(run, time_s):
    """The first tick at or after a time; the last one if there is none."""
    return min(np.searchsorted(run.time, time_s - 5e-7), len(run) - 1)


def pressing(run):
    """The surface holds the proxy back: the HIP is more than 1.01 r_c away from it."""
    return np.linalg.norm(run.hip_position - run.proxy_position, axis=1) > 1.01 * CONTACT_RADIUS_M


def raised_m(run, position):
    """Heights over the height at HELD_S."""
    return position[:, 1] - position[tick_of(run, HELD_S), 1]


class Handshake:
    """The runs of one hand: pressed by a HIP that follows the frames; the same with an exact sensor; and a simulated hand with mass
    that wants to stay at a position inside. The hand that is touched moves in the same way in all of them."""

    def __init__(self, s, hand):
        self.pressed, self.exact = s.runs([("handshake", hand), ("handshake", {**hand, **EXACT_SENSOR})])
        self.held_m = self.pressed.hip_position[tick_of(self.pressed, HELD_S)]
        inside_m = self.held_m - DEEPER_M * UP
        waypoints = [[*(inside_m + FROM_ABOVE_M * UP), 0], [*inside_m, REACHING_M_PER_S]]
        self.passive = s.run("handshake", {**hand, "trajectory": {"name": "waypoints", "waypoints": waypoints}, "operator": {}})
        self.scene, exact_scene = (rt.scene(**run.config["scenario"]) for run in (self.pressed, self.exact))
        self.time = self.pressed.time
        height_m = np.array([self.scene.true_objects(time_s)[0][1][1, 3] for time_s in [0, *self.time]])
        self.up_m = height_m[1:] - height_m[0]
        ends = np.arange(-1, len(self.time) - 1).clip(0), np.arange(1, len(self.time) + 1).clip(max=len(self.time) - 1)
        self.velocity_m_per_s = np.subtract(*self.up_m[ends[::-1], ]) / np.subtract(*self.time[ends[::-1], ])
        self.gaps, self.passive_gaps = (ball_gaps(run, self.scene) for run in (self.pressed, self.passive))
        self.exact_gaps = ball_gaps(self.exact, exact_scene)
        self.depth_error = depth_error_at_proxy(self.pressed, self.gaps, self.scene)
        self.sink_m = deepest_sink_m(exact_scene.cloud(0), self.held_m)
        self.touches = ~np.isnan(self.gaps.now)

    def largest_gap_m(self):
        """The bound on the gap to the moving hand: its way between two frames, the largest error of a depth, and how deep the ball
        sinks between points."""
        return np.abs(self.velocity_m_per_s).max() / FRAMES_HZ + largest_error_m(self.depth_error) + self.sink_m

    def derived_age_gap_m(self):
        """The surface that a frame shows is 0 to 1 / f_c old, so its rms displacement is v_rms / (3^(1/2) f_c)."""
        return rms(self.velocity_m_per_s[self.touches]) / (math.sqrt(3) * FRAMES_HZ)

    def passive_motion(self):
        """Sinusoids in whole periods of the shake, from the second on: of the surface, the HIP and the force."""
        run = self.passive
        settled = (run.time >= SETTLED_S) & (run.time < RESTS_S)
        return [Sinusoid(*theory.sinusoid_in(run.time[settled], values[settled], SHAKE_HZ))
                for values in (self.up_m, raised_m(run, run.hip_position), run.force[:, 1])]


def ball_gaps(run, scene):
    ticks = np.flatnonzero((run.frame_index >= 0) & pressing(run))
    gaps = Gaps(*np.full((2, len(run)), np.nan))
    gaps.now[ticks] = run.signed_distance[ticks] - CONTACT_RADIUS_M
    captured_s = run.frame_index[ticks] / scene.frame_rate_hz
    gaps.at_capture[ticks] = scene.signed_distances(run.proxy_position[ticks], captured_s) - CONTACT_RADIUS_M
    return gaps


def rms(values):
    known = values[~np.isnan(values)]
    return math.sqrt(np.mean(known**2)) if len(known) else math.nan


def largest(values):
    return np.fmax.reduce(np.abs(values))


def depth_error_at_proxy(run, gaps, scene):
    """The error of a depth along the optical axis at the largest depth z of the proxy in contact: z^2 / (f b) times the standard
    deviation of the disparity, and times half of its step."""
    pose = scene.cloud(0).camera_pose
    z_m = ((run.proxy_position[~np.isnan(gaps.now)] - pose[:3, 3]) @ pose[:3, 2]).max(initial=0)
    names = ("sensor", "focal_px", "baseline_m", "disparity_focal_px", "noise_px", "disparity_step_px")
    sensor = rt.DepthSensor(**{name: run.config["scenario"][name] for name in names}).triangulation
    per_px = z_m * z_m / (sensor["focal_px"] * sensor["baseline_m"])
    return per_px * sensor["noise_px"], 0.5 * per_px * sensor["step_px"]


def largest_error_m(depth_error):
    sigma_m, rounding_m = depth_error
    return 3 * sigma_m + rounding_m


def deepest_sink_m(cloud, middle_m):
    """How deep the ball sinks between four neighbouring points of the palm, without noise: r - (r^2 - a^2)^(1/2), where 2 a is the
    longer diagonal of the four points. Squares with a side above r, which have a depth edge, are left out."""
    points = cloud.points.reshape(-1, cloud.columns, 3)
    a, b, c, d = points[:-1, :-1], points[:-1, 1:], points[1:, :-1], points[1:, 1:]

    def longest(*sides):
        return np.max([np.linalg.norm(side, axis=2) for side in sides], axis=0)
    chosen = (longest(b - a, c - a, d - b, d - c) < CONTACT_RADIUS_M) & (np.linalg.norm(a - middle_m, axis=2) < PALM_M)
    half_m = 0.5 * longest(d - a, c - b)[chosen]
    return max(CONTACT_RADIUS_M - np.sqrt(CONTACT_RADIUS_M**2 - half_m**2), default=math.nan)


def derived_hand(config):
    """A passive hand of mass m, a spring k and a damper c on a surface of stiffness K that shakes: amplitude of the hand, divided
    by that of the surface, K / |K + k - m w^2 + i c w|; amplitude of the force over that of the hand, |k - m w^2 + i c w|; the lag,
    s."""
    w, hand, surface = 2 * math.pi * SHAKE_HZ, config["operator"], config["renderer"]["stiffness_N_per_m"]
    own, damping = hand["stiffness_N_per_m"] - hand["mass_kg"] * w * w, hand["damping_Ns_per_m"] * w
    return surface / math.hypot(surface + own, damping), math.hypot(own, damping), math.atan2(damping, surface + own) / w


def add_run(s, name, title, shake, run, gaps, exact_gaps=None):
    columns = {"time": (run.time, "s", "simulated time"),
               "hand": (shake.up_m, "m", "height of the shaking hand over its position at rest"),
               "hip": (raised_m(run, run.hip_position), "m", "height of the HIP over that at 0.45 s"),
               "proxy": (raised_m(run, run.proxy_position), "m", "height of the proxy over that at 0.45 s"),
               "gap": (gaps.now, "m", "from the proxy's ball to the true surface; NaN: no contact"),
               "gap_at_capture": (gaps.at_capture, "m", "to the true surface at the capture of the newest frame"),
               "force": (run.norm("force"), "N", "magnitude of the force")}
    if exact_gaps:
        columns["exact_gap"] = (exact_gaps.at_capture, "m", "gap_at_capture with a sensor without noise and rounding")
    s.table(name, title, {column: (values[::STRIDE], *texts) for column, (values, *texts) in columns.items()})


def add_summary(s, shake):
    ratio, _, lag_s = derived_hand(shake.passive.config)
    surface, hip, force = shake.passive_motion()
    sigma_m, rounding_m = shake.depth_error
    measured_lag_s = math.remainder(surface.phase_rad - hip.phase_rad, 2 * math.pi) / (2 * math.pi * SHAKE_HZ)
    numbers = {
        "rms gap to the moving hand": ("m", rms(shake.gaps.now)),
        "largest gap to the moving hand": ("m", largest(shake.gaps.now)),
        "rms gap, derived from the age of the frames alone": ("m", shake.derived_age_gap_m()),
        "rms gap to the hand at capture": ("m", rms(shake.gaps.at_capture)),
        "largest gap to the hand at capture": ("m", largest(shake.gaps.at_capture)),
        "rms gap to the hand at capture, exact sensor": ("m", rms(shake.exact_gaps.at_capture)),
        "standard deviation of a depth at the proxy": ("m", sigma_m),
        "half a step of the depth": ("m", rounding_m),
        "deepest sink between points of the palm": ("m", shake.sink_m),
        "maximum force, pressed": ("N", shake.pressed.measures["max_force"]),
        "amplitude of the shaking hand": ("m", surface.amplitude),
        "amplitude of the passive hand": ("m", hip.amplitude),
        "amplitude of the passive hand, derived": ("m", ratio * surface.amplitude),
        "lag of the passive hand": ("s", measured_lag_s),
        "lag of the passive hand, derived without the age of frames": ("s", lag_s),
        "amplitude of the force on the passive hand": ("N", force.amplitude)}
    units, values = zip(*numbers.values())
    s.table("summary", "numbers of the runs", quantity=([*numbers], "1", "what was measured"),
            unit=(units, "1", "unit of the value in this row"), value=(values, "1", "measured or derived value"))


def add_picture(s, shake):
    """The points of the frames in which the hand is highest and lowest, and the proxy at the first."""
    axes = "xyz"
    for name, time_s in (("lowest", LOWEST_S), ("highest", HIGHEST_S)):
        points = shake.scene.cloud(shake.scene.newest_frame(time_s)).points
        points = points[np.isfinite(points).all(axis=1)]
        s.table(name, f"points of the frame at {time_s:.6f}"[:-4] + " s",
                {axis: (points[:, i], "m", f"{axis} of the point") for i, axis in enumerate(axes)})
    proxy_m = shake.pressed.proxy_position[tick_of(shake.pressed, HIGHEST_S)]
    s.table("proxy", "proxy when the hand is highest", {axis: ([proxy_m[i]], "m", axis) for i, axis in enumerate(axes)})
    parts = (("lowest", 0x8478F0, 0.0022, "lowest position"), ("highest", 0x546030, 0.0022, "highest position"),
             ("proxy", 0x146BAB, 0.01, "proxy"))
    s.panel("What the camera sees of the hand", "", "", [], at=(0, 0), scene={
        "eye": (0.42, 0.30, 0.30), "target": (0, 0.115, 0), "up": (0, 1, 0), "width_m": 0.30, "height_per_width": 0.62,
        "parts": [{"kind": "points", "table": table, "colour": colour, "size_m": size_m, "label": label}
                  for table, colour, size_m, label in parts]})


def add_panels(s, shake):
    bound_m = np.full(2, shake.largest_gap_m())
    s.table("bounds", "bound on the gap to the moving hand", time=(SHOWN_S, "s", "simulated time"),
            high=(bound_m, "m", "upper bound"), low=(-bound_m, "m", "lower bound"))
    add_picture(s, shake)

    def over_time(title, y_label, at, table, *curves):
        s.panel(title, "time (s)", y_label, [style(of or table, "time", y, label) for style, y, label, of in curves], at=at,
                x_range=SHOWN_S)
    hand, hip = (line, "hand", "true hand", ""), (dashed, "hip", "HIP", "")
    over_time("Pressed by a HIP that follows the frames", "displacement (m)", (0, 1), "pressed", hand, hip,
              (line, "proxy", "proxy", ""))
    over_time("Gap between the proxy's ball and the hand", "gap (m)", (1, 0), "pressed", (line, "high", "bound", "bounds"),
              (line, "low", "bound", "bounds"), (line, "gap", "to the moving hand", ""),
              (line, "gap_at_capture", "to the hand at capture", ""), (line, "exact_gap", "at capture, exact sensor", ""))
    over_time("Force on the pressing HIP", "force (N)", (1, 1), "pressed", (line, "force", "", ""))
    over_time("A passive hand is shaken", "displacement (m)", (2, 0), "passive", hand, hip)
    over_time("Force on the passive hand", "force (N)", (2, 1), "passive", (line, "force", "", ""))


def add_sound_claims(s, where, run):
    judged = run.frame_index >= 0
    has_force = np.isfinite(run.force).all(axis=1) & run.force.any(axis=1)
    claims = s.claims(where)
    claims.at_most("the proxy is never on the wrong side of the surface: fraction of ticks in which it is",
                   np.mean(~(run.signed_distance[judged] >= 0)), 0, "fraction", "none")
    claims.at_most("all numbers are finite: fraction of ticks with one that is not", run.measures["non_finite_fraction"], 0,
                   "fraction", "none")
    claims.at_most("the HIP is never held back without force: fraction of ticks in which it is", np.mean(~has_force[pressing(run)]),
                   0, "fraction", "none")
    shaken = (run.time >= SHAKES_S) & (run.time < RESTS_S)
    claims.at_least("the contact is not lost during the shake: fraction of its ticks with a force",
                    np.mean(run.norm("force")[shaken] > 0), 1, "fraction")


def add_claims(s, shake):
    add_sound_claims(s, "pressed: ", shake.pressed)
    add_sound_claims(s, "passive hand: ", shake.passive)
    claims = s.claims()
    claims.at_most("the proxy keeps to the moving hand within its way between two frames, the largest error of a depth and the "
                   "sink between points: largest gap", largest(shake.gaps.now), shake.largest_gap_m(), "m")
    claims.between("most of the gap is the age of the frame: rms gap, divided by v_rms / (3^(1/2) f_c)",
                   rms(shake.gaps.now) / shake.derived_age_gap_m(), 0.85, 1.15, "1")
    claims.at_most("to the hand as the newest frame saw it, the gap is within the largest error of a depth: largest gap",
                   largest(shake.gaps.at_capture), largest_error_m(shake.depth_error) + shake.sink_m, "m")
    claims.at_most("with a sensor without noise and rounding, the ball only sinks between points: largest gap to the hand as the "
                   "newest frame saw it", largest(shake.exact_gaps.at_capture), shake.sink_m, "m")
    ratio, force_N_per_m, _ = derived_hand(shake.passive.config)
    surface, hip, force = shake.passive_motion()
    claims.between("the shake moves a passive hand: amplitude of the HIP, divided by that of the shaking hand and by the derived "
                   "ratio", hip.amplitude / surface.amplitude / ratio, 0.9, 1.1, "1")
    claims.between("the force on a passive hand follows the shake: amplitude, divided by the derived one",
                   force.amplitude / (force_N_per_m * ratio * surface.amplitude), 0.9, 1.1, "1")


def shaken(s, hand):
    shake = Handshake(s, hand)
    add_run(s, "pressed", "pressed by a HIP that follows the frames", shake, shake.pressed, shake.gaps, shake.exact_gaps)
    add_run(s, "passive", "a passive hand, held at a position", shake, shake.passive, shake.passive_gaps)
    add_summary(s, shake)
    add_panels(s, shake)
    add_claims(s, shake)


@study("handshake", "a hand that shakes before a depth camera is pressed, and shakes a passive hand (1.1)",
       title="Remote handshake", caption="The remote handshake of 1.1. The built-in hand `fork` " + CAPTION)
def handshake(s):
    shaken(s, {})


@study("handshake-human", "the figure handshake with the mesh of a human hand", title="Remote handshake with a human hand",
       caption="The figure handshake with the mesh of a human hand. The hand " + CAPTION)
def handshake_human(s):
    shaken(s, {"scenario.mesh": "meshes/hand_closed.obj", "scenario.mesh_rotation_deg": [-90, 0, 0]})


if __name__ == "__main__":
    sys.exit(main())
