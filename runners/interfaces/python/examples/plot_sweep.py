"""Reads a sweep into xarray and plots it.

Run it: remote-touch sweep map.json -o map.h5, then python3 plot_sweep.py map.h5 map.png. Without a sweep it makes one.
"""
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import remote_touch as rt

SWEEP = {
    "title": "error of the surface over noise and acceleration",
    "experiment": "fig4.12",
    "set": {"duration_s": 0.6},
    "axes": [{"parameter": "scenario.noise_sigma_m", "from": 0, "to": 0.002, "count": 5},
             {"parameter": "scenario.acceleration_m_per_s2", "values": [0.5, 1, 2]}],
    "replicates": 3,
    "measures": ["rms_surface_error", "max_force"],
}
MEASURE = SWEEP["measures"][0]


def plot(sweep, file):
    """Mean and spread of a measure over the first axis, a line for each value of the second where there is one."""
    x, *others = [name for name in sweep.sizes if name != "replicate"]
    mean, spread = sweep[MEASURE].mean("replicate"), sweep[MEASURE].std("replicate")
    figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
    if not others:
        axes.errorbar(sweep[x], mean, spread, capsize=3)
    elif len(others) == 1:
        lines = others[0]
        for value in sweep[lines].values:
            axes.errorbar(sweep[x], mean.sel({lines: value}), spread.sel({lines: value}), capsize=3,
                          label=f"{value:g} {sweep[lines].attrs['units']}")
        axes.legend(title=lines)
    else:
        sys.exit(f"plot_sweep.py: {len(others) + 1} axes: expected one or two")
    axes.set_xlabel(f"{x} / {sweep[x].attrs['units']}")
    axes.set_ylabel(f"{MEASURE} / {sweep[MEASURE].attrs['units']}")
    axes.set_title(f"version {sweep.attrs['version']}, digest {sweep.attrs['digest'][:12]}")
    figure.savefig(file, dpi=100)
    plt.close(figure)


def main(arguments):
    if len(arguments) == 2:
        sweep, picture = rt.open(arguments[0]), arguments[1]
    else:
        sweep, picture = rt.sweep(SWEEP, output="map.h5"), "map.png"
    plot(sweep, picture)
    print(f"{picture}: {dict(sweep.sizes)}, {MEASURE} at most {float(sweep[MEASURE].max()):.3g}")


if __name__ == "__main__":
    main(sys.argv[1:])
