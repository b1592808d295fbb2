"""Whether (4.23), (4.24) and the 16 r_c/s of the predecessor [1] can come from one machine: runs over the number of proxy steps
that a machine makes in a frame."""
import dataclasses
import itertools
import sys

import numpy as np

from remote_touch.studies import dashed, dots, line, main, study

R1_M, RC_M = 0.00499, 0.005
FRAMES_HZ, PRINTED_RC_PER_S = 30, 16
SETTLED_FRAME = 20  # the sixth update after the rise
FAST_STEPS = 1000  # steps in a frame at the dissertation's own 30 kHz
STEPS = np.array([33, 40, 50, 60, 70, 80, FAST_STEPS])  # proxy steps in a frame
NOISE_M, REPLICATES = 2 * RC_M * np.arange(11) / 10, 20
# Below r_c the fits are not compared: the printed digits allow almost no deviation there, and (4.23) is up to 0.2 mm above every
# machine.
COMPARED = NOISE_M > RC_M - 1e-9
STRENGTHS = COMPARED.sum()

# [1]: the velocities between which the bisection begins, and its number of steps.
HOLDS_RC_PER_S, POPS_RC_PER_S, HALVINGS = 0, 40, 8


@dataclasses.dataclass(frozen=True)
class PrintedFit:
    """A polynomial in the noise (m), the highest power first, and half a unit of the last digit of each coefficient."""
    coefficients: tuple
    half_digits: tuple

    def at(self, noise_m):
        return np.polyval(self.coefficients, noise_m)

    def rms(self, values):
        """Root mean square of the distance from the fit, for each machine."""
        return np.sqrt(np.mean((values - self.at(NOISE_M)) ** 2, axis=-1))

    def in_band(self, values):
        """The number of noise strengths from r_c on at which the values lie in what the printed digits allow."""
        inside = np.abs(values - self.at(NOISE_M)) <= np.polyval(self.half_digits, NOISE_M)
        return np.where(np.isnan(values[..., COMPARED]).any(axis=-1), np.nan, (inside & COMPARED).sum(axis=-1))


H = PrintedFit((5.5e4, -6.7e3, 63, 1, -4.1e-5), (0.05e4, 0.05e3, 0.5, 0.05, 0.05e-5))  # (4.23), m
E_N = PrintedFit((2.9e10, -6.4e8, 4.8e6, -1.2e4, 16, 0), (0.05e10, 0.05e8, 0.05e6, 0.05e4, 0.5, 0))  # (4.24)


def machine(steps):
    """The settings of a machine that makes so many steps in a frame."""
    per_tick = 3 if steps == FAST_STEPS else 1
    return {"haptic_rate_hz": steps * FRAMES_HZ / per_tick, "renderer.steps_per_tick": per_tick}


# --- h and e_n over lifts without acceleration ---

def noise_means(run):
    """h and e_n before an update, and e_n over all steps, while the proxy is above the plane; NaN if it popped through before the
    first update that counts."""
    distance_m, e_n = run.signed_distance, 1 - run.normal[:, 1]
    counts = (run.frame_index >= SETTLED_FRAME) & (distance_m > 0)
    counts[-1] = False
    ends = run.frame_updates() - 1
    ends = ends[counts[ends]]
    if not len(ends):
        return [np.nan] * 3
    return [(distance_m[ends] - R1_M).mean(), e_n[ends].mean(), e_n[counts].mean()]


def machines(s):
    """h (m), e_n before an update, and e_n over time: each for every machine and noise, the mean over its lifts. The fast machine
    sees the clouds that the first one sees."""
    jobs = [("fig4.12", {"scenario.acceleration_m_per_s2": 0, "scenario.acceleration_s": 40 / 30, "duration_s": 56 / 30,
                         **machine(steps), "scenario.noise_sigma_m": noise_m,
                         "cell": i % (len(STEPS) - 1) * len(NOISE_M) + j, "replicate": replicate})
            for (i, steps), (j, noise_m), replicate in itertools.product(enumerate(STEPS), enumerate(NOISE_M), range(REPLICATES))]
    means = np.array(s.measure(jobs, noise_means)).reshape(len(STEPS), len(NOISE_M), REPLICATES, 3)
    return np.moveaxis(np.nanmean(means, axis=2), 2, 0)


# --- the predecessor ---

def rise(steps, step_m, velocity_m_per_s):
    """A noise-free plane that rises at a constant velocity for four seconds."""
    return "fig4.12", {"scenario.noise_sigma_m": 0, "scenario.acceleration_m_per_s2": 0,
                       "scenario.start_velocity_m_per_s": round(velocity_m_per_s, 6),
                       "scenario.start_depth_m": round(velocity_m_per_s / 2, 6),
                       "scenario.rise_s": 4, "scenario.acceleration_s": 0, "duration_s": 4, "renderer.velocity_estimate": False,
                       "renderer.step_rule": "fixed", "renderer.fixed_step_m": step_m, **machine(steps)}


def predecessors(s):
    """Steps in a frame and their length, and by bisection the velocity above which the predecessor pops through, r_c/s. The last
    length of each machine adds up to what 16 r_c/s need in a frame, and no more."""
    steps = np.repeat(STEPS, 6)
    step_m = np.ravel([[2e-5, 3.5e-5, 5e-5, 8e-5, 1e-4, PRINTED_RC_PER_S * RC_M / FRAMES_HZ / each] for each in STEPS])
    holds, pops = np.full(len(steps), float(HOLDS_RC_PER_S)), np.full(len(steps), float(POPS_RC_PER_S))
    for _ in range(HALVINGS):
        middle = (holds + pops) / 2
        lost = s.measure(map(rise, steps, step_m, middle * RC_M), lambda run: int(run.measures["popped_through"]))  # raises for NaN
        holds, pops = np.where(lost, holds, middle), np.where(lost, middle, pops)
    return steps, step_m, (holds + pops) / 2


def expected_rc_per_s(steps, step_m):
    """The proxy cannot climb faster than by all its steps of a frame, and it is lost if an update moves the surface by more than
    r_1."""
    return np.minimum(steps * step_m, R1_M) * FRAMES_HZ / RC_M


# --- the figure ---

@study("proxy-rates", "whether (4.23), (4.24) and the 16 r_c/s of [1] can come from one machine",
       title="One machine for (4.23), (4.24) and 16 r_c/s?", caption="""
       Can (4.23), (4.24) and the 16 r_c/s above which the predecessor (reference [1] of the dissertation) popped through come from
       one machine? Yes, from one that makes 60 to 80 proxy steps in a frame (1.8 to 2.4 kHz), if e_n is averaged over all steps of
       a frame, and if the fixed steps of the predecessor add up to 2.67 mm in a frame: 0.044 to 0.033 mm each. Then h and e_n lie
       in what the printed digits allow for all noise from r_c to 2 r_c. With 33 to 50 steps h is too large above 1.6 r_c; with
       1000 steps, the 30 kHz that the dissertation names, e_n is about half as large as printed. e_n just before an update, which
       decides pop-through, is smaller than over time: no machine has it and h as printed. Below r_c no machine gives the printed h
       to its digits: it is up to 0.2 mm less. The velocity of the predecessor says nothing about the machine: without noise the
       predicted velocity is the steps of a frame times their length times f_c, and at most r_1 f_c = 30 r_c/s. Lifts without
       acceleration, 20 for each noise and machine; simulated.""")
def proxy_rates(s):
    h, at_end, in_time = machines(s)
    before = predecessors(s)
    draw_machines(s, h, at_end, in_time)
    draw_predecessors(s, *before)
    s.place_in_rows(2)
    claim_machines(s, h, at_end, in_time)
    claim_predecessors(s, *before)


def draw_machines(s, h, at_end, in_time):
    noise = "r_c", "standard deviation of the noise"
    for i, steps in enumerate(STEPS):
        s.table(f"steps_{steps}", f"{steps} proxy steps in a frame",
                noise=(NOISE_M / RC_M, *noise),
                thickness=(h[i], "m", "h before an update, mean"),
                at_end=(at_end[i], "1", "e_n before an update, mean"),
                in_time=(in_time[i], "1", "e_n, mean over all steps of a frame"),
                printed_thickness=(H.at(NOISE_M), "m", "(4.23)"),
                printed_normal_error=(E_N.at(NOISE_M), "1", "(4.24)"))
    in_digits = "noise strengths with that in what the digits of (4.24) allow"
    s.table("machines", "how near each machine comes to (4.23) and (4.24), noise to 2 r_c",
            steps=(STEPS, "1", "proxy steps in a frame"),
            h_rms=(H.rms(h), "m", "h against (4.23), rms"),
            h_in_band=(H.in_band(h), "1", "noise strengths, of 6 from r_c on, with h in what the digits of (4.23) allow"),
            at_end_rms=(E_N.rms(at_end), "1", "e_n before an update against (4.24), rms"),
            at_end_in_band=(E_N.in_band(at_end), "1", in_digits),
            in_time_rms=(E_N.rms(in_time), "1", "e_n over all steps against (4.24), rms"),
            in_time_in_band=(E_N.in_band(in_time), "1", in_digits),
            at_end_2_rc=(at_end[:, -1], "1", "e_n before an update at 2 r_c"),
            in_time_2_rc=(in_time[:, -1], "1", "e_n over all steps at 2 r_c"))
    rc = np.arange(0, 201, 2) / 100
    s.table("printed", "printed fits", noise=(rc, *noise), thickness=(H.at(rc * RC_M), "m", "h (4.23)"),
            normal_error=(E_N.at(rc * RC_M), "1", "e_n (4.24)"))
    for title, label, column, printed, y_range in (
            ("Thickness of the cloud (4.23)", "h (m)", "thickness", "thickness", None),
            ("Error of the normal before an update (4.24)", "e_n", "at_end", "normal_error", (-0.01, 0.28)),
            ("Error of the normal, mean over time (4.24)", "e_n", "in_time", "normal_error", (-0.01, 0.28))):
        s.panel(title, "noise (r_c)", label,
                [*(line(f"steps_{steps}", "noise", column, f"{steps} steps") for steps in STEPS[[0, -2, -1]]),
                 dashed("printed", "noise", printed, "printed")], y_range=y_range)


def draw_predecessors(s, steps, step_m, critical):
    s.table("predecessor", "velocity above which the predecessor pops through, without noise",
            steps=(steps, "1", "proxy steps in a frame"),
            step=(step_m, "m", "length of a step"),
            critical=(critical, "r_c/s", "velocity above which it pops through"),
            expected=(expected_rc_per_s(steps, step_m), "r_c/s", "steps times their length in a frame, at most r_1, times f_c"))
    s.table("equal", "velocities that are equal", predicted=(range(31), "r_c/s", "predicted velocity"),
            measured=(range(31), "r_c/s", "measured velocity"))
    s.panel("Velocity that the predecessor holds", "predicted (r_c/s)", "measured (r_c/s)",
            [dashed("equal", "predicted", "measured", "equal"), dots("predecessor", "expected", "critical", "measured")])


def claim_machines(s, h, at_end, in_time):
    both, both_at_end = (np.minimum(H.in_band(h), E_N.in_band(e_n)) for e_n in (in_time, at_end))
    digits = "in the digits of (4.23) and (4.24) at all 6 noise strengths from r_c to 2 r_c"
    claims = s.claims()
    claims.at_least(f"machines with 60, 70 and 80 steps per frame give h and e_n, averaged over time, {digits}: "
                    "smallest number of strengths", both[(STEPS >= 60) & (STEPS <= 80)].min(), STRENGTHS, "strengths", "6")
    claims.differs(f"machines with 33, 40 and 50 steps per frame do not give h and e_n, averaged over time, {digits}: "
                   "largest number of strengths", both[STEPS < 60].max(), 0, STRENGTHS - 1, "strengths", "6")
    claims.differs("a machine with 1000 steps per frame (30 kHz, 4.3.4) does not give h and e_n, averaged over time, "
                   f"{digits}: number of strengths", both[STEPS == FAST_STEPS].max(), 0, STRENGTHS - 1, "strengths", "6")
    claims.differs(f"no machine gives h over time and e_n before an update {digits}: largest number of strengths",
                   both_at_end.max(), 0, STRENGTHS - 1, "strengths", "6")


def claim_predecessors(s, steps, step_m, critical):
    """Tolerances: a fixed step of 0.1 mm may leave the proxy that much too low, it sinks 0.11 mm between four points, and the
    bisection ends 0.16 r_c/s wide. A lag of r_1 in 3.5 s adds 0.3 r_c/s."""
    apart, slow = (1e-4 + 1.1e-4) * FRAMES_HZ / RC_M + 0.16, 0.16 + 0.3
    expected = expected_rc_per_s(steps, step_m)
    printed = critical[np.abs(expected - PRINTED_RC_PER_S) <= 1e-9]
    sixteen = "with 2.67 mm of steps in a frame the predecessor [1] pops through above 16 r_c/s"
    claims = s.claims()
    claims.at_most("the predecessor [1] pops through above the velocity steps x length x f_c (at most r_1 f_c): largest difference",
                   np.abs(critical - expected).max(), apart, "r_c/s")
    claims.between(f"{sixteen}: smallest velocity over the machines", printed.min(), PRINTED_RC_PER_S - slow,
                   PRINTED_RC_PER_S + slow, "r_c/s", "16")
    claims.between(f"{sixteen}: largest velocity over the machines", printed.max(), PRINTED_RC_PER_S - slow,
                   PRINTED_RC_PER_S + slow, "r_c/s", "16")
    claims.differs("with steps of 0.1 mm at 30 kHz the predecessor [1] pops through above a higher velocity than printed: velocity",
                   critical[(steps == FAST_STEPS) & (step_m == 1e-4)].item(), 28, 30, "r_c/s", "16")


if __name__ == "__main__":
    sys.exit(main())
