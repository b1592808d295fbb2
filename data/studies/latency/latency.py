"""Violation of a fixture when frames arrive late, at irregular times or not at all. Chapter 8 names this question and does not
measure it."""
import itertools
import sys

import numpy as np

from remote_touch.studies import band, color_map, dashed, dots, line, main, study

# Settings of the experiments late-surface and late-heart.
REGION_M, CONTACT_M, FRAME_RATE_HZ = 0.02, 0.005, 30
SPEED_M_PER_S, LATENCY_S = 0.1, 0.05
SETTLED_FROM_S = 1.5  # the velocity estimate has settled by this time

LATENCIES_S = SPEEDS_M_PER_S = 0.2 * np.arange(21) / 20
JITTERS_S, DROPS, REPLICATES = 0.15 * np.arange(16) / 15, 0.5 * np.arange(11) / 10, 20
HEART_LATENCIES_S, HEART_RATES_PER_MIN = 0.3 * np.arange(13) / 12, (40, 75, 120)

# A proxy of radius r_f + r_c sinks between points 1.5 mm apart, in the middle of four, and rests within 0.01 mm of r_c.
SINKS_MM = 1.5 * 1.5 / 4 / 25 + 0.01
# Frames arrive every 33 1/3 ticks, so the oldest frame is at most a third of a tick younger than the rule states, on a surface of
# up to 0.2 m/s. With jitter it is a tick, at 0.1 m/s.
THIRD_OF_TICK_MM, TICK_MM = 0.2 / 3, 0.1


def predicted_mm(speed_m_per_s, latency_s):
    """A frame shows the surface as it was at its capture, latency_s before its arrival. It is one frame interval older still when
    the next frame arrives."""
    return 1e3 * speed_m_per_s * (latency_s + 1 / FRAME_RATE_HZ)


def violations_mm(run):
    """The largest depth of the slave's contact point inside the region of the surface as it is at that moment: of the whole run,
    and of its settled part."""
    depths_mm = 1e3 * (REGION_M + CONTACT_M - run.slave_distance)
    return depths_mm.max(), depths_mm[run.time >= SETTLED_FROM_S].max()


def violations(s, experiment, axes, replicates=1):
    """The violations over the axes and the replicates: (largest, settled) with the slave sent to the proxy, and settled with the
    slave sent ahead of it. Each run has its own noise: that of its cell and replicate."""
    counts = [*map(len, axes.values()), replicates]
    cells = [{**dict(zip(axes, values)), "cell": cell} for cell, values in enumerate(itertools.product(*axes.values()))]
    jobs = [(experiment, {**cell, "replicate": replicate, "renderer.slave_prediction": is_ahead,
                          # Frames become older here than the default limit up to which a prediction is used.
                          "renderer.max_prediction_s": 0.4})
            for is_ahead in (False, True) for cell in cells for replicate in range(replicates)]
    plain, ahead = np.reshape(s.measure(jobs, violations_mm), (2, *counts, 2))
    return plain[..., 0], plain[..., 1], ahead[..., 1]


@study("latency", "how far a forbidden region is violated when frames arrive late, irregularly or not at all",
       title="Fixtures from late frames", caption="""
       A surface with r_f = 20 mm rises evenly against a pressing HIP, and frames arrive late; simulated. Latency: the time
       from the capture of a frame to its arrival. Depth: how deep the contact point of the slave, which is sent to the proxy,
       is inside the region of the surface, both at the same moment. Shown is the largest depth of a run. It is the distance
       that the surface moves in the latency and one frame interval; the correction (4.3) does not change that. At 20 mm the
       slave reaches the surface itself. In the flat corner of the map the surface has passed the proxy, and the slave is at
       the HIP, 10 mm behind the surface: there the depth is r_f + r_c + 10 mm = 35 mm. Settled: from 1.5 s on, when the
       velocity estimate has settled. Slave sent ahead: the slave is sent ahead of the proxy by the velocity estimate times the
       age of the frame, which is not in the dissertation.""")
def latency(s):
    draw_map(s)
    draw_jitter(s)
    draw_drops(s)
    draw_heart(s)
    s.place_in_rows(2)


def draw_map(s):
    largest, _, ahead = violations(s, "late-surface", {"frame_latency_s": LATENCIES_S,
                                                       "scenario.start_velocity_m_per_s": SPEEDS_M_PER_S})
    latency_s, speed = (axis.ravel() for axis in np.meshgrid(LATENCIES_S, SPEEDS_M_PER_S, indexing="ij"))
    rows = s.table("delay_and_speed", "violation of a fixture on a surface that rises evenly",
                   latency=(1e3 * latency_s, "ms", "time from capture to arrival"),
                   speed=(speed, "m/s", "speed of the surface"),
                   violation=(largest.ravel(), "mm", "largest depth of the slave in the region"),
                   predicted=(predicted_mm(speed, latency_s), "mm", "speed times (latency + one frame interval)"),
                   with_prediction=(ahead.ravel(), "mm", "depth with the slave sent ahead, from 1.5 s on"))
    # The latencies and speeds at which the predicted violation is r_f: the slave then reaches the surface that the fixture
    # protects.
    at_ms = np.arange(67, 201)
    s.table("tissue", "where the slave reaches the surface itself",
            latency=(at_ms, "ms", "time from capture to arrival"),
            speed=(1e3 * REGION_M / predicted_mm(1, 1e-3 * at_ms), "m/s", "speed of the surface"))
    s.panel("Violation by latency and speed", "latency (ms)", "speed of the surface (m/s)",
            [color_map("delay_and_speed", "latency", "speed", z="violation"),
             line("tissue", "latency", "speed", "predicted to reach the surface")], y_range=(-0.005, 0.205))
    region_mm = 1e3 * REGION_M
    below = rows.predicted < region_mm
    claims = s.claims()
    claims.at_most("the violation is the speed times (latency + frame interval) as long as that is below r_f: largest difference",
                   np.abs(rows.violation - rows.predicted)[below].max(), THIRD_OF_TICK_MM + SINKS_MM, "mm")
    claims.at_least("speed times (latency + frame interval) predicts whether the slave reaches the surface: fraction of the cells "
                    "of the map", np.mean((rows.violation > region_mm) == (rows.predicted > region_mm)), 0.99, "fraction")
    claims.at_most("no settled violation below r_f remains when the slave is sent ahead: largest violation",
                   rows.with_prediction[below].max(initial=0), SINKS_MM, "mm")


def spread(s, name, axis, values, column, extra):
    """Adds the table of the runs over one axis. column: the values and their unit. extra: more columns."""
    largest, _, ahead = violations(s, "late-surface", {axis: values}, REPLICATES)
    return s.table(name, "violation over 20 runs", {
        name: (*column, axis),
        "mean": (largest.mean(axis=1), "mm", "mean of the runs' largest depths"),
        "max": (largest.max(axis=1), "mm", "maximum of the runs"),
        "with_prediction": (ahead.mean(axis=1), "mm", "mean with the slave sent ahead, from 1.5 s on"), **extra})


def draw_spread(s, name, title, x_label, curves=()):
    s.panel(title, x_label, "largest depth in the region (mm)",
            [*curves, dots(name, name, "max", "maximum of 20 runs"), line(name, name, "mean", "mean"),
             dashed(name, name, "with_prediction", "slave sent ahead, settled")])


def draw_jitter(s):
    early, late = (predicted_mm(SPEED_M_PER_S, LATENCY_S + jitter_s) for jitter_s in (np.zeros_like(JITTERS_S), JITTERS_S))
    rows = spread(s, "jitter", "frame_jitter_s", JITTERS_S, (1e3 * JITTERS_S, "ms"),
                  {"all_early": (early, "mm", "speed times (latency + one interval)"),
                   "all_late": (late, "mm", "speed times (latency + jitter + one interval)")})
    draw_spread(s, "jitter", "Irregular latency of 50 ms, 0.1 m/s", "jitter (ms)",
                [band("jitter", "jitter", "all_early", "bounds", z="all_late")])
    s.claims().at_most("with jitter the violation stays between those of all frames early and all frames late: largest distance "
                       "outside", np.maximum(rows["max"] - late, early - rows["mean"]).max(initial=0), TICK_MM + SINKS_MM, "mm")


def draw_drops(s):
    rows = spread(s, "drops", "frame_drop_probability", DROPS, (DROPS, "1"), {})
    draw_spread(s, "drops", "Lost frames, latency of 50 ms, 0.1 m/s", "share of frames lost")
    s.claims().at_least("lost frames increase the mean violation: value at a loss of 0.3 over that at 0",
                        rows["mean"][np.isclose(DROPS, 0.3)][0] / rows["mean"][0], 1.5)


def draw_heart(s):
    _, settled, ahead = violations(s, "late-heart", {"frame_latency_s": HEART_LATENCIES_S,
                                                     "scenario.rate_per_min": HEART_RATES_PER_MIN})
    columns, curves = {"latency": (1e3 * HEART_LATENCIES_S, "ms", "from capture to arrival")}, []
    for k, rate in enumerate(HEART_RATES_PER_MIN):
        name, label = f"rate_{rate}", f"{rate} beats per minute"
        columns[name] = (settled[:, k, 0], "mm", "largest depth of the slave in the region, from 1.5 s on")
        columns[f"{name}_ahead"] = (ahead[:, k, 0], "mm", "the same with the slave sent ahead")
        curves += [line("heart", "latency", name, label), dashed("heart", "latency", f"{name}_ahead", f"{label}, slave sent ahead")]
    s.table("heart", "violation of a fixture on a beating heart", columns)
    s.panel("Beating heart, sensor noise, from 1.5 s on", "latency (ms)", "largest depth in the region (mm)", curves)


if __name__ == "__main__":
    sys.exit(main())
