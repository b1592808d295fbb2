"""The largest stable stiffness of renderers on a device with a damper, over the damper and the delay."""
import itertools
import sys

import numpy as np
from wall_limit import limit_columns, wall, wall_limits, wall_task

from remote_touch.studies import Rows, dots, line, main, study

RENDERERS = ("proxy", "tracked-sheet", "god-object", "surfels", "mls-surface", "penalty")
DELAY_TICKS = {0: "Without delay beyond the hold", 5: "Delay of 5 ms"}
DAMPING_NS_PER_M = np.array([0.2, 0.5, 1.0])


def case(renderer, delay_ticks, damping):
    settings = {"renderer": {"name": renderer}, "device.damping_Ns_per_m": damping, "device.delay_ticks": delay_ticks}
    return lambda stiffness: wall_task(stiffness, settings), wall(damping, delay_ticks)


@study("device-wall", "up to which stiffness a rendered plane is stable, over damping and delay of the device",
       title="The largest stable stiffness of a rendered plane", source="the theory of sampled walls", caption="""
       A light hand without damping rests on a plane that a device renders; the device has a damper. The dots show the stiffness of
       the renderer up to which no oscillation grows, found by bisection; the line is the limit of a linear wall. The points have no
       noise and rest. Simulated.""")
def device_wall(s):
    limits = wall_limits(s, [case(*each) for each in itertools.product(RENDERERS, DELAY_TICKS, DAMPING_NS_PER_M)])
    curves = [*itertools.product(RENDERERS, DELAY_TICKS)]
    of = {curve: Rows({name: column.reshape(len(curves), -1)[i] for name, column in limits.items()})
          for i, curve in enumerate(curves)}
    for delay_ticks, title in DELAY_TICKS.items():
        draw(s, title, delay_ticks, of)
    for (renderer, delay_ticks), rows in of.items():
        # A penalty force pushes from the nearest point, which lies beside the hand. Its stiffness along the normal is therefore
        # smaller than the setting, and its limit larger.
        s.claims(renderer + (", delay of 5 ms: " if delay_ticks else ", without delay: ")).at_most(
            "the largest stable stiffness is b / (T / 2 + delay): largest relative difference",
            np.abs(rows.stiffness / rows.expected - 1).max(), 0.2 if renderer == "penalty" else 0.05, "fraction")


def draw(s, title, delay_ticks, of):
    names = {renderer: f"{renderer.replace('-', '_')}_delay_{delay_ticks}" for renderer in RENDERERS}
    for renderer, name in names.items():
        s.table(name, f"limits of {renderer}", damping=(DAMPING_NS_PER_M, "N s/m", "damping of the device"),
                **limit_columns(of[renderer, delay_ticks]))
    s.panel(title, "damping of the device (N s/m)", "largest stable stiffness (N/m)",
            [line(names["proxy"], "damping", "expected", "b / (T / 2 + delay), derived"),
             *(dots(name, "damping", "stiffness", renderer) for renderer, name in names.items())])


if __name__ == "__main__":
    sys.exit(main())
