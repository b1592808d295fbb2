"""The largest stiffness of a renderer at which no oscillation of a hand on a plane grows, by bisection, and that of a linear wall.
A stiffness is along the normal of the plane, N/m, or of the rotation of a tool that lies on it, N m/rad."""
import numpy as np

from remote_touch import theory
from remote_touch.studies import Rows

HALVINGS = 7  # the limit is then known to 1.4 %
# The hand is in contact, on a path at rest, from 1.6 s on. An oscillation that grows is larger in the second window.
WINDOW_S = (2.0, 2.8, 3.6)
# Smaller oscillations are the last steps of a proxy, 0.02 mm and less, and not an instability.
LEAST_SWING_M = 5e-5
LEAST_SWING_RAD = 5e-4  # moves the border of a plate by 0.01 mm


def bisected(low, high, halvings, is_high):
    """The middles, by ratio, of the last intervals. is_high(values): whether each is above what is looked for."""
    for _ in range(halvings):
        middle = np.sqrt(low * high)
        above = np.asarray(is_high(middle))
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    return np.sqrt(low * high)


def turn_about_z_rad(run):
    """Of the hand; z is an axis in the plane."""
    w, axis = run.hip_orientation[:, 0], run.hip_orientation[:, 1:]
    sine = np.linalg.norm(axis, axis=1)
    angle = 2 * np.arctan2(sine, np.abs(w)) * np.where(w < 0, -1, 1)
    return angle * axis[:, 2] / np.where(sine > 0, sine, 1)


def grows(run, values, least):
    """An unknown position is no proof of stability."""
    windows = [(run.time >= start_s) & (run.time < end_s) for start_s, end_s in zip(WINDOW_S, WINDOW_S[1:])]
    first, second = (np.ptp(values[window]) for window in windows)
    return not np.isfinite(first + second) or (second > least and second > first)


def is_unstable(run):
    """An oscillation that grows until the hand leaves the surface no longer grows, so a contact that opens counts too."""
    opens = not (run.norm("force")[run.time >= WINDOW_S[1]] > 0).all()
    turns = "hip_orientation" in run.columns and grows(run, turn_about_z_rad(run), LEAST_SWING_RAD)
    return opens or turns or grows(run, run.hip_position[:, 1], LEAST_SWING_M)


def wall_limits(s, cases):
    """Rows with the largest stable stiffness of each case, the limit of the law and the exact one.

    cases: (task, wall). task(stiffness): (experiment, settings) of a run in which the hand rests on a plane from 1.6 s on, until
    3.6 s. wall: the linear wall, as of theory.wall_law_N_per_m().
    """
    expected = np.array([theory.wall_law_N_per_m(**wall) for _, wall in cases])
    stiffness = bisected(0.4 * expected, 2.5 * expected, HALVINGS, lambda values: s.measure(
        [task(value) for (task, _), value in zip(cases, values)], is_unstable))
    exact = np.array([theory.exact_wall_limit_N_per_m(**wall) for _, wall in cases])
    return Rows(stiffness=stiffness, expected=expected, exact=exact)


def limit_columns(rows, unit="N/m"):
    """Of a table."""
    return {"stiffness": (rows.stiffness, unit, "largest stable stiffness"),
            "expected": (rows.expected, unit, "limit of a linear wall, law"),
            "exact": (rows.exact, unit, "limit of a linear wall, eigenvalues")}


def wall_task(stiffness_N_per_m, settings):
    """The spring of the hand has a quarter of the stiffness, so that the hand stays in contact and does not sink through a penalty
    force."""
    return "virtual-wall", {**settings, "renderer.stiffness_N_per_m": stiffness_N_per_m,
                            "operator.stiffness_N_per_m": stiffness_N_per_m / 4}


def wall(damping, delay_ticks=0, mass_kg=0.3):
    """The linear wall of that hand. damping: of hand and device, N s/m; of a rotation N m s/rad, and kg m^2."""
    return {"mass_kg": mass_kg, "damping_Ns_per_m": damping, "spring_share": 0.25, "delay_ticks": delay_ticks}
