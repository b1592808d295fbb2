"""The largest force on a slave that approaches a surface and presses: over its bandwidth, the delay, and what the hand feels."""
import sys

import numpy as np
from slave_tasks import APPROACH_M_PER_S, APPROACH_TO_M, DELAYS_S, MASS_KG, RADIUS_M, STIFFNESS_N_PER_M, approach_task, \
    stopped_height_m

from remote_touch import theory
from remote_touch.studies import dashed, dots, main, study

HIT_FROM_M = 0.1
HIT_FREQUENCIES_HZ = (1, 2, 4, 8, 16)
# Each table shows one kind of force on the hand: title, feedback, and radius of the forbidden region, by the name of the table.
FELT = {"rendered": ("Rendered force", "rendered", 0),
        "region": ("Rendered force, region of 5 mm", "rendered", 0.005),
        "none": ("No force", "none", 0),
        "slave_force": ("Force of the slave", "slave-force", 0)}


def derived_N(feedback, region_m, frequency_hz):
    """F + (F^2 + K m v^2)^(1/2), with the speed v of the slave at the surface; 0 if it does not reach it.

    The force of the slave does not change the commands before the slave touches, so v is that without a force. Without a force
    on the hand the drive pushes with at most its spring at the end of the path and its damper while the command still moves:
    F = m w^2 (x - c) + 2 m w v_c. A rendered command waits at the surface; the ball between four points lies a little below it.
    With the force of the slave the result is that of the first impact without a push.
    """
    end_m = stopped_height_m(region_m) if feedback == "rendered" else APPROACH_TO_M
    impact = theory.first_impact(speed_m_per_s=APPROACH_M_PER_S, way_m=HIT_FROM_M - end_m, gap_m=end_m - RADIUS_M,
                                 natural_frequency_hz=frequency_hz)
    if impact is None:
        return 0
    w, push_N = 2 * np.pi * frequency_hz, 0
    if feedback == "none":
        push_N = MASS_KG * w * w * (RADIUS_M - APPROACH_TO_M) + 2 * MASS_KG * w * APPROACH_M_PER_S
    if feedback == "rendered" and region_m == 0:
        push_N = MASS_KG * w * w * (RADIUS_M - end_m)
    return theory.impact_force_N(push_N=push_N, stiffness_N_per_m=STIFFNESS_N_PER_M, mass_kg=MASS_KG, speed_m_per_s=impact[1])


@study("slave-force-peak", "how hard a slave hits a surface at rest, over its bandwidth, the delay and what the hand feels",
       title="How hard a slave hits a surface at rest", source="the theory of a linear slave", caption="""
       A hand approaches a plane at 0.2 m/s and presses 20 mm below it; a slave of 2 kg follows. The dots show the largest
       force of the scene on the slave over its natural frequency, for several delays in each direction. The dashed line is F +
       (F^2 + K m v^2)^(1/2), with the derived speed v of the slave at the surface and the largest force F of its drive; F is 0
       behind a region and with the force of the slave. There is no noise. Simulated.""")
def slave_force_peak(s):
    jobs = [approach_task(HIT_FROM_M, True, frequency_hz=hz, delay_s=delay_s, feedback=feedback, region_m=region_m)
            for _, feedback, region_m in FELT.values() for hz in HIT_FREQUENCIES_HZ for delay_s in DELAYS_S]
    measured_N = np.reshape(s.measure(jobs, lambda run: run.measures["max_slave_force"]),
                            (len(FELT), len(HIT_FREQUENCIES_HZ), len(DELAYS_S)))
    peaks_N = dict(zip(FELT, measured_N))  # over the frequency and the delay
    forces_N = {name: np.array([derived_N(feedback, region_m, hz) for hz in HIT_FREQUENCIES_HZ])
                for name, (_, feedback, region_m) in FELT.items()}
    for name in FELT:
        draw(s, name, peaks_N[name], forces_N[name])
    s.place_in_rows(2)
    add_claims(s, peaks_N, forces_N)


def draw(s, name, peaks_N, derived):
    title = FELT[name][0]
    delays = {f"delay_{1000 * delay_s:.0f}_ms": f"{1000 * delay_s:.0f} ms" for delay_s in DELAYS_S}
    s.table(name, title,
            frequency=(HIT_FREQUENCIES_HZ, "Hz", "natural frequency of the slave"),
            derived=(derived, "N", "derived force"),
            **{column: (peaks_N[:, k], "N", "largest force on the slave") for k, column in enumerate(delays)})
    label = "first impact, derived" if name == "slave_force" else "bound of the impact"
    s.panel(title, "natural frequency (Hz)", "largest force (N)",
            [dashed(name, "frequency", "derived", label), *(dots(name, "frequency", *delay) for delay in delays.items())])


def add_claims(s, peaks_N, forces_N):
    touches = {name: forces_N[name] > 0 for name in FELT}
    ratios = {name: peaks_N[name][touches[name]] / forces_N[name][touches[name], None] for name in FELT}
    late = np.array(DELAYS_S) >= 0.05
    claims = s.claims("a slave that hits a plane: ")
    claims.at_most("without a force on the hand no impact is harder than F + (F^2 + K m v^2)^(1/2): largest ratio",
                   ratios["none"].max(), 1)
    claims.at_most("with the rendered force no impact is harder than that of the derived speed: largest ratio",
                   ratios["rendered"].max(), 1.02)
    claims.at_most("behind a region of 5 mm no impact is harder than that of the derived speed: largest ratio",
                   ratios["region"].max(), 1.02)
    claims.at_least("a slave that is derived to touch hits the plane: smallest ratio to the derived force",
                    np.min([each.min() for each in ratios.values()]), 0.25)
    claims.at_most("a region keeps a slave from touching if its derived overshoot is smaller than the radius of the region: "
                   "largest force", peaks_N["region"][~touches["region"]].max(), 0, "N")
    claims.at_most("a delay does not change the impact on a plane at rest unless the hand feels the force of the slave: "
                   "largest change of the force",
                   np.max([np.ptp(peaks_N[name], axis=1) for name in ("rendered", "region", "none")]), 0.5, "N")
    claims.at_least("the force of the slave comes too late to soften the first impact, from 50 ms in each direction on: "
                    "smallest ratio to v (K m)^(1/2)", ratios["slave_force"][:, late].min(), 0.9)


if __name__ == "__main__":
    sys.exit(main())
