"""The time by which the hand feels a contact before the slave touches."""
import math
import sys

import numpy as np
from slave_tasks import APPROACH_M_PER_S, DELAYS_S, FREQUENCIES_HZ, RADIUS_M, approach_task, stopped_height_m

from remote_touch import theory
from remote_touch.studies import dots, line, main, study

FROM_M = 0.04


def derived_s(run, cell):
    """The rendered force begins when the HIP reaches the surface, r_c after the proxy has. The commands arrive late by the delay,
    and the slave is behind them. The force of the slave arrives later than its touch by the delay."""
    if cell.feedback == "slave-force":
        return -cell.delay
    end_m = stopped_height_m(0)
    impact = theory.first_impact(speed_m_per_s=APPROACH_M_PER_S, way_m=FROM_M - end_m, gap_m=end_m - RADIUS_M,
                                 natural_frequency_hz=cell.frequency)
    return impact[0] + cell.delay - FROM_M / APPROACH_M_PER_S if impact else math.nan


@study("anticipation", "the time by which the hand feels a contact before the slave touches, over delay and bandwidth",
       title="The time by which the hand feels a contact before the slave touches", source="the theory of a linear slave",
       caption="""
       A hand on a path approaches a plane at 0.2 m/s, from 40 mm above it. The panels show the time from the first force on
       the hand to the first force on the slave, over the delay in each direction, for slaves of several natural frequencies:
       measured (dots), and derived from delay, response of the slave and r_c / v (lines). If it is negative, the hand feels
       the contact after the slave. There is no noise and no region. Simulated.""")
def anticipation(s):
    warnings = s.grid({"feedback": ("rendered", "slave-force"), "frequency": FREQUENCIES_HZ, "delay": DELAYS_S},
                      lambda cell: approach_task(FROM_M, False, frequency_hz=cell.frequency, delay_s=cell.delay,
                                                 feedback=cell.feedback),
                      {"measured": lambda run: run.measures["slave_anticipation"], "derived": derived_s})
    rendered, of_slave = (warnings.where(feedback=feedback) for feedback in ("rendered", "slave-force"))
    draw(s, "Rendered force", "rendered", rendered)
    draw(s, "Force of the slave", "slave_force", of_slave)
    s.place_in_rows(2)
    claims = s.claims("a slave that approaches a plane: ")
    # A tick for each of the two first forces, and one in which the command moves the slave.
    claims.at_most("the rendered force comes before the touch by the delay of the commands and the lag of the slave, less r_c / v: "
                   "largest difference", np.abs(rendered.measured - rendered.derived).max(), 0.003, "s")
    claims.at_most("the force of the slave comes after the touch by the delay of the forces: largest difference",
                   np.abs(of_slave.measured - of_slave.derived).max(), 0.003, "s")


def draw(s, title, prefix, warnings):
    curves = []
    for hz in FREQUENCIES_HZ:
        rows, name = warnings.where(frequency=hz), f"{prefix}_{hz}_hz"
        s.table(name, f"{title}, {hz} Hz",
                delay=(rows.delay, "s", "delay of commands and forces"),
                measured=(rows.measured, "s", "time from the force on the hand to that on the slave"),
                derived=(rows.derived, "s", "derived time"))
        curves += [line(name, "delay", "derived", f"{hz} Hz, derived"), dots(name, "delay", "measured", f"{hz} Hz")]
    s.panel(title, "delay in each direction (s)", "anticipation (s)", curves)


if __name__ == "__main__":
    sys.exit(main())
