"""(4.14) at other frame rates than the printed one: the critical acceleration grows with the square of the rate."""
import sys

import numpy as np

from remote_touch.studies import dots, line, main, study

R1_M = 0.00499


def bound(frame_rate_hz):
    """(4.14): r_1 f_c^2, m/s^2."""
    return R1_M * frame_rate_hz ** 2


@study("frame-rates", "up to which acceleration the proxy stays on a surface, at 15, 30 and 60 frames per second",
       title="Pop-through at other frame rates", caption="""
       The same motion without noise, seen at 15, 30 and 60 frames per second: up to which acceleration the proxy stays on the
       surface. Below: the same accelerations divided by r_1 f_c^2. Rise at 0.05 m/s, acceleration for a third of a second;
       simulated.""")
def frame_rates(s):
    lifts = s.sweep("frame-rates")
    rates, accelerations = lifts.frame_rate_hz.values, lifts.acceleration_m_per_s2.values
    popped = lifts.popped_through.values[:, :, 0]
    pops = np.where(popped == 0, np.inf, popped * accelerations).min(axis=1)  # NaN if an outcome is unknown
    survives = np.where(accelerations < pops[:, None], accelerations, 0).max(axis=1)
    draw(s, rates, survives, pops)
    # The range of 3 % has two reasons: the proxy sinks up to 0.113 mm between four points, and the axis has steps of 1 %. See
    # figure "bounds".
    claims = s.claims()
    for rate, critical in zip(rates, np.sqrt(survives * pops)):
        claims.between(f"without noise the critical acceleration at {rate:.0f} frames per second is r_1 f_c^2: ratio",
                       critical / bound(rate), 0.97, 1.03, "1", "1 (4.14)")
    claims.at_most("no lift survives above its critical acceleration: lifts that do",
                   ((popped == 0) & (accelerations > pops[:, None])).sum(), 0, "lifts")


def draw(s, rates, survives, pops):
    s.table("critical", "critical acceleration without noise, by frame rate",
            frame_rate=(rates, "Hz", "f_c"),
            survives=(survives, "m/s^2", "largest acceleration below which no lift popped through"),
            pops=(pops, "m/s^2", "smallest acceleration with pop-through"),
            bound=(bound(rates), "m/s^2", "r_1 f_c^2 (4.14)"),
            survives_ratio=(survives / bound(rates), "1", "survives, in r_1 f_c^2"),
            pops_ratio=(pops / bound(rates), "1", "pops, in r_1 f_c^2"))
    hz = np.arange(10, 71)
    s.table("bound", "(4.14)", frame_rate=(hz, "Hz", "f_c"), bound=(bound(hz), "m/s^2", "r_1 f_c^2"),
            ratio=(np.ones(len(hz)), "1", "r_1 f_c^2 in r_1 f_c^2"))
    for title, label, curve, measured, y_range in (
            ("Critical acceleration", "acceleration (m/s^2)", "bound", ("survives", "pops"), None),
            ("Ratio to r_1 f_c^2", "ratio", "ratio", ("survives_ratio", "pops_ratio"), (0.96, 1.01))):
        s.panel(title, "frame rate (Hz)", label,
                [line("bound", "frame_rate", curve, "r_1 f_c^2 (4.14)"),
                 dots("critical", "frame_rate", measured[0], "no pop-through up to here"),
                 dots("critical", "frame_rate", measured[1], "pop-through")], y_range=y_range)


if __name__ == "__main__":
    sys.exit(main())
