"""Pictures: how times grow with leaves, points and runs, and the error of normals against their time."""
import re

from benchmarks.aims import ASKED_TOOL_TICK_MS, LEVELS
from benchmarks.depth_tables import TRADE_KINDS, trade_rows

TOOL_SPACING_MM = {"1089": 3, "2500": 2, "40000": 1, "40000_dense": 0.5, "111556_dense": 0.3}


def draw_growth(times, file):
    """How a tick grows with the leaves of the tool: the husky's slide, as a multiple of that with the fewest leaves."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    curves = {}
    for name in times.ns:
        match = re.fullmatch(r"region_tick/husky_(\d+)_slide/(.+)", name)
        if match:
            counters = times.counters[name]
            curves.setdefault(match[2], []).append((int(match[1]), counters["mean_ns"], counters["p99_9_ns"]))
    plot = plt.figure(figsize=(6.4, 4)).gca()
    for number, (level, points) in enumerate(sorted(curves.items())):
        leaves, mean, slow = zip(*sorted(points))
        colour = f"C{number}"
        plot.loglog(leaves, [value / mean[0] for value in mean], "o-", color=colour, label=f"{level}, mean")
        plot.loglog(leaves, [value / mean[0] for value in slow], "s--", color=colour, label=f"{level}, p99.9")
    first = min(points[0] for points in curves[level])
    plot.loglog([first, 1000], [1, 1000 / first], ":", color="grey", label="in proportion")
    plot.set_xlabel("leaves of the tool, among 3714 regions")
    plot.set_ylabel(f"time of a tick / mean with {first} leaves")
    plot.grid(True, which="both", linewidth=0.3)
    plot.legend(fontsize=8)
    plot.figure.tight_layout()
    plot.figure.savefig(file, dpi=120)
    print(f"\nGrowth of a tick with the leaves: {file}")


def draw_tool_growth(times, file):
    """How a step and a tick of the look-ahead rule grow as the husky's points come closer together."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    curves = {}
    for points, spacing_mm in TOOL_SPACING_MM.items():
        for level in LEVELS:
            step, tick = (f"{kind}/{points}_look-ahead/{level}" for kind in ("tool_step", "tool_tick"))
            if step in times.ns and tick in times.ns:
                curves.setdefault(level, []).append(
                    (spacing_mm, times.ns[step] / 1000, times.counters[tick]["p99_9_ns"] / 1000))
    plot = plt.figure(figsize=(6.4, 4)).gca()
    for number, (level, rows) in enumerate(sorted(curves.items())):
        spacing_mm, step_us, tick_us = zip(*rows)
        plot.loglog(spacing_mm, step_us, "o-", color=f"C{number}", label=f"{level}, step")
        plot.loglog(spacing_mm, tick_us, "s--", color=f"C{number}", label=f"{level}, tick, p99.9")
    plot.axhline(1000 * ASKED_TOOL_TICK_MS, linestyle=":", color="grey", label="asked of a tick")
    plot.invert_xaxis()
    plot.set_xlabel("spacing of the points, mm")
    plot.set_ylabel("us")
    plot.grid(True, which="both", linewidth=0.3)
    plot.legend(fontsize=8)
    plot.figure.tight_layout()
    plot.figure.savefig(file, dpi=120)
    print(f"\nGrowth of steps and ticks of the tool with its points: {file}")


def draw_sweep_growth(rows, file):
    """How the time of the processor, memory and files of sweeps grow with the number of runs. rows: what sweep_growth prints."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    figure, plots = plt.subplots(1, 3, figsize=(12, 4))
    for plot, (quantity, label) in zip(plots, (("processor_s", "time of the processor, s"), ("memory_MB", "memory, MB"), ("file_MB", "file, MB"))):
        for number, what in enumerate(dict.fromkeys(row["what"] for row in rows)):
            points = [(row["runs"], row[quantity]) for row in rows if row["what"] == what]
            plot.loglog(*zip(*points), "os^Dv"[number] + "-", color=f"C{number}", label=what, markersize=4)
        plot.set_xlabel("runs of the sweep")
        plot.set_ylabel(label)
        plot.grid(True, which="major", linewidth=0.3)
    plots[0].legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(file, dpi=120)
    print(f"\nGrowth of sweeps with their runs: {file}")


def draw_trade(trade, file):
    """The error of normals against their time: a row for each noise, a column for each kind of pixel."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    families = [("this project", "ours_", "o", "C3"), ("3F2N", "3f2n_", "^", "C0"), ("D2NT", "d2nt", "v", "C2"),
                ("PCL", "pcl_", "s", "C4"), ("OpenCV FALS", "opencv_", "D", "C1")]
    noises = ("0.5", "1.0", "2.0")
    figure, plots = plt.subplots(len(noises), len(TRADE_KINDS), figsize=(13, 8.5), sharex=True, sharey="col")
    for row, noise in zip(plots, noises):
        for plot, kind in zip(row, TRADE_KINDS):
            for label, start, mark, colour in families:
                points = sorted((ms, by_noise[noise]["deg_" + kind]) for method, (ms, by_noise) in trade_rows(trade).items()
                                if method.startswith(start) and noise in by_noise)
                plot.loglog(*zip(*points), mark, color=colour, label=label, markersize=5, linewidth=0.8)
            ms, by_noise = trade_rows(trade)["ours_fast"]
            plot.plot(ms, by_noise[noise]["deg_" + kind], "*", color="black", markersize=11, label="fast setting")
            plot.grid(True, which="both", linewidth=0.3)
            plot.set_title(f"{kind}, {noise} mm noise", fontsize=9)
    for plot in plots[:, 0]:
        plot.set_ylabel("rms angle, deg")
    for plot in plots[-1]:
        plot.set_xlabel("ms, one thread")
    plots[0][0].legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(file, dpi=110)
    print(f"\nError of normals against their time: {file}")
