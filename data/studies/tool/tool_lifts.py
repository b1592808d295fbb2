"""The question of chapter 4 for tools: up to which speed does a surface carry a plate that is pressed onto it, and how do
thickness, tilt, rotation and noise change that?"""
import sys

import numpy as np
from carried_limits import FRAMES_HZ, RULES, Carried, draw_limits, jump_m, rows_apart

from remote_touch.studies import main, study

THIN_PLATE_M, PLATE_LENGTH_M, NOISE_PLATE_M = 0.005, 0.04, 0.01
THICKNESSES_M = [0.005, 0.01, 0.02]  # of the tools of sweep tool-lifts


def rising_m_per_s(rule, thickness_m):
    return FRAMES_HZ * jump_m(rule, thickness_m)


def tilted_m_per_s(rule, tilt_deg):
    """The plate lies flat on a tilted surface, which approaches along its normal by v cos(tilt) / f_c."""
    return rising_m_per_s(rule, THIN_PLATE_M) / np.cos(np.radians(tilt_deg))


def turning_deg(rule, lever_m):
    """The surface turns by A sin(2 pi f t): by about 2 pi f A / f_c in the first frame. The end of the plate that is nearer to the
    axis moves least, and the plate is lost if the surface passes through that end too."""
    near_m, turn = lever_m - PLATE_LENGTH_M / 2, np.sin(2 * np.pi / FRAMES_HZ)
    with np.errstate(divide="ignore"):  # an end over the axis does not move
        return np.degrees(jump_m(rule, THIN_PLATE_M) / np.float64(near_m) / turn)


def accelerated_m_per_s2(rule, noise_m):
    """With a velocity estimate: without noise."""
    return FRAMES_HZ * FRAMES_HZ * jump_m(rule, NOISE_PLATE_M)


def add_limits(s, sweep, table, title, setting, units, derived, x_label, y_label, y_range, at):
    """The limits of a sweep over a setting, and those that are derived for it: the table, and a panel. Returns its rows."""
    carried = Carried(s.sweep(sweep))
    settings = THICKNESSES_M if table == "lifts" else carried.settings
    columns = {setting[0]: (settings, *setting[1:])}
    for rule in RULES:
        up_to, lost, _ = carried.limits(rule)
        columns |= {f"{rule}_carried": (up_to, units, "all runs are carried up to this"),
                    f"{rule}_first_lost": (lost, units, "the next value: a run is lost"),
                    f"{rule}_bound": ([derived(rule, value) for value in settings], units, "derived limit")}
    draw_limits(s, table, title, setting, settings, units, derived, x_label, y_label, at=at, y_range=y_range)
    return s.table(table, title, columns)


@study("tool-lifts", "up to which speed, tilt, turn and acceleration a plate stays on a surface, by three contact rules",
       title="Where a plate loses the surface that it is pressed onto", caption="""
       A surface of points rises, rises tilted, turns or accelerates under a plate of 40 x 40 mm, by the three contact rules;
       frames at 30 Hz; simulated. Dots: up to here every run is carried. Bars: up to the next value that was tried, at which
       a run is lost; arrows: no run is lost up to the end of the sweep, 45 deg or 14 m/s^2. The three rules are drawn side
       by side for each setting. Dashed: derived without noise, one frame moves the surface through the plate (printed rule:
       through what is not shell; continuous rule: by more than frame_reach_m, 20 mm). On the surface that turns, the derived
       angles of the continuous rule are above the panel, at 137 deg and more.""")
def tool_lifts(s):
    lifts = add_limits(s, "tool-lifts", "lifts", "Speed up to which a plate is carried",
                       ("thickness", "m", "thickness of the plate"), "m/s", rising_m_per_s,
                       "thickness h (m)", "speed (m/s)", (0, 0.7), (0, 0))
    tilts = add_limits(s, "tool-tilts", "tilts", "Speed of a tilted surface, plate of 5 mm",
                       ("tilt", "deg", "tilt of the surface"), "m/s", tilted_m_per_s,
                       "tilt (deg)", "speed (m/s)", (0, 1.4), (0, 1))
    turns = add_limits(s, "tool-turns", "turns", "Surface that turns at 1 Hz, plate of 5 mm",
                       ("lever", "m", "from the axis to the middle of the plate"), "deg", turning_deg,
                       "distance from the axis (m)", "amplitude (deg)", (0, 100), (1, 0))
    noise = add_limits(s, "tool-noise", "noise", "With a velocity estimate, plate of 10 mm",
                       ("noise", "m", "standard deviation of the noise on x, y and z"), "m/s^2", accelerated_m_per_s2,
                       "noise (m)", "acceleration (m/s^2)", (0, 20), (1, 1))

    claims = s.claims()
    for rows, rule, upper, text in (
            (lifts, "voxels", "voxels", "the printed rule carries a plate up to the speed f_c (h - 2w) of the surface"),
            (lifts, "look_ahead", "look_ahead", "look-ahead carries a plate up to the speed f_c h of the surface"),
            (lifts, "continuous", "continuous",
             "the continuous rule carries a plate, however thin it is, up to the speed f_c frame_reach_m of the surface"),
            (tilts, "voxels", "continuous",
             "on a tilted surface, the printed rule carries a plate at least up to the speed f_c (h - 2w) / cos(tilt)"),
            (tilts, "look_ahead", "look_ahead",
             "on a tilted surface, look-ahead carries a plate up to the speed f_c h / cos(tilt)"),
            (tilts, "continuous", "continuous",
             "on a tilted surface, the continuous rule carries a plate up to the speed f_c frame_reach_m / cos(tilt)"),
            (turns, "voxels", "look_ahead",
             "on a surface that turns, the printed rule carries a plate until its nearer end moves by h - 2w to h in a frame"),
            (turns, "look_ahead", "look_ahead",
             "on a surface that turns, look-ahead carries a plate until its nearer end passes through"),
            (turns, "continuous", "continuous",
             "on a surface that turns, the continuous rule carries a plate at every speed that was tried")):
        # no run is lost below the bound of the rule, and none is carried above that of `upper`
        apart = rows_apart(rows, f"{rule}_carried", f"{rule}_first_lost", f"{rule}_bound", f"{upper}_bound")
        claims.at_most(f"{text}: number of settings in which this is false", apart, 0,
                       paper="v < f_c (h - 2w), 6.2.4" if rows is lifts and rule == "voxels" else "-")
    claims.at_least("noise up to 4 mm does not lower the acceleration at which the printed rule carries a plate: smallest change",
                    (noise.voxels_carried - noise.voxels_carried[0]).min(), 0, "m/s^2")
    claims.at_least("with noise up to 2 mm, the continuous rule carries a plate: acceleration that it carries at every noise",
                    noise.continuous_carried[:-1].min(), 14, "m/s^2")


if __name__ == "__main__":
    sys.exit(main())
