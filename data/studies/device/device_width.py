"""The largest stable stiffness with a tool, of its rotation, with another hand, other frame rates and noise, and the energy that
the hand gets at frame updates, with each sign of the velocity term of (4.15)."""
import dataclasses
import math
import sys

import numpy as np
from noisy_wall import noisy_walls
from wall_limit import limit_columns, wall, wall_limits, wall_task

from remote_touch.studies import Rows, dashed, dots, line, main, study

DAMPING_NS_PER_M = 0.5
SIGNS, SEEDS = ("minus", "plus", "none"), range(1, 5)
PLATE = {"name": "tool", "tool_mesh": "slab-10"}  # 10 mm thick; the hand lays it flat on the plane
LAW = "b / (T / 2 + delay)"


def plane(frame_rate_hz=30):
    """A plane at rest that is seen again and again."""
    return {"name": "moving-shape", "columns": 60, "rows": 60, "normals": True, "rise_s": 3.5, "frame_rate_hz": frame_rate_hz}


# --- stiffness ---

@dataclasses.dataclass
class Width:
    """A curve. axis: name, unit, values. case(value): (task, wall) as of wall_limits()."""
    name: str
    title: str
    axis: tuple
    case: object
    limits: Rows = None


def case(settings, linear_wall):
    settings = {**settings, "device.delay_ticks": linear_wall["delay_ticks"]}
    return lambda stiffness: wall_task(stiffness, settings), linear_wall


def flat_plate(damping, delay_ticks):
    return case({"renderer": PLATE, "scenario": plane(), "trajectory.waypoints": [[0, 0.012, 0, 0], [0, -0.002, 0, 0.01]],
                 "device.damping_Ns_per_m": damping}, wall(damping, delay_ticks))


def turned_plate(damping, delay_ticks):
    """The hand lays the plate flat on the plane and then turns about an axis in the plane. The plane holds the plate, so the
    rotation is a wall with the stiffness of the rotational coupling. The stiffness along the normal is below its own limit, 4000
    or 364 N/m."""
    normal_N_per_m, inertia_kg_m2 = 200, 1e-3
    settings = {"renderer": PLATE, "scenario": plane(),
                "trajectory": {"name": "poses", "poses": [[0, 0.012, 0, 0, 0, 0, 0], [0, -0.002, 0, 0, 0, 0, 1.2],
                                                          [0, -0.002, 0, 0, 0, 2, 0]]},
                "device.damping_Ns_per_m": 2, "device.rotational_damping_Nms_per_rad": damping,
                "operator.rotational_damping_Nms_per_rad": 0, "device.delay_ticks": delay_ticks}

    def task(stiffness_Nm_per_rad):
        radius_m = math.sqrt(stiffness_Nm_per_rad / normal_N_per_m)
        return wall_task(normal_N_per_m, {**settings, "renderer.gyration_radius_m": radius_m,
                                          "operator.rotational_stiffness_Nm_per_rad": stiffness_Nm_per_rad / 4})
    return task, wall(damping, delay_ticks, inertia_kg_m2)


def hand_of(mass_kg):
    return case({"operator.mass_kg": mass_kg, "device.damping_Ns_per_m": DAMPING_NS_PER_M}, wall(DAMPING_NS_PER_M, 0, mass_kg))


def damped_wall(mass_kg):
    """A damper of the wall, with a delay and a velocity over several ticks: the lighter the hand, the less does the law hold,
    because the damper is late, too."""
    return case({"operator.mass_kg": mass_kg, "device.damping_Ns_per_m": 2, "device.contact_damping_Ns_per_m": 10,
                 "device.velocity_ticks": 5}, {**wall(2, 3, mass_kg), "wall_damping_Ns_per_m": 10, "velocity_ticks": 5})


def damped_hand(damping):
    """The damper of the hand acts at once and adds to that of the device."""
    return case({"operator.damping_Ns_per_m": damping, "device.damping_Ns_per_m": DAMPING_NS_PER_M},
                wall(DAMPING_NS_PER_M + damping))


def seen_at(frame_rate_hz):
    return case({"scenario": plane(frame_rate_hz), "device.damping_Ns_per_m": DAMPING_NS_PER_M}, wall(DAMPING_NS_PER_M))


def widths(s):
    plate, turn = ("damping", "N s/m", [0.2, 0.5, 1.0]), ("damping", "N m s/rad", [5e-4, 1e-3, 2e-3])
    curves = [*(Width(f"tool_delay_{ticks}", f"tool, delay of {ticks} ms", plate, lambda b, ticks=ticks: flat_plate(b, ticks))
                for ticks in (0, 5)),
              *(Width(f"turn_delay_{ticks}", f"rotation of the tool, delay of {ticks} ms", turn,
                      lambda b, ticks=ticks: turned_plate(b, ticks)) for ticks in (0, 5)),
              Width("mass", "mass of the hand", ("mass", "kg", [0.1, 0.3, 1.0]), hand_of),
              Width("hand", "damping of the hand", ("damping", "N s/m", [0, 0.25, 0.5, 1.0]), damped_hand),
              Width("rate", "frame rate", ("frame_rate", "Hz", [15, 30, 60]), seen_at),
              Width("wall_damper", "mass of the hand, damper of the wall", ("mass", "kg", [0.1, 0.2, 0.5, 1.0]), damped_wall)]
    limits = wall_limits(s, [curve.case(value) for curve in curves for value in curve.axis[2]])
    ends = np.cumsum([len(curve.axis[2]) for curve in curves])[:-1]
    for curve, *columns in zip(curves, *(np.split(column, ends) for column in limits.values())):
        curve.limits = Rows(zip(limits, columns))
    return curves


def draw_widths(s, curves, title, x_label, unit="N/m", law=LAW):
    drawn = []
    for curve in curves:
        axis, axis_unit, values = curve.axis
        s.table(curve.name, f"limits over {curve.title}",
                {axis: (values, axis_unit, curve.title), **limit_columns(curve.limits, unit)})
        drawn.append(line(curve.name, axis, "expected", f"{law}, derived"))
        if curve.name == "wall_damper":
            drawn.append(dashed(curve.name, axis, "exact", "exact"))
        drawn.append(dots(curve.name, axis, "stiffness", curve.title if len(curves) > 1 else "measured"))
    highest = max(max(curve.limits.stiffness.max(), curve.limits.expected.max()) for curve in curves)
    s.panel(title, x_label, f"largest stable stiffness ({unit})", drawn, y_range=(0, 1.15 * highest))


def draw_noise(s, walls):
    s.table("noise", "largest stiffness of a calm hand over the noise",
            noise=(walls.noise, "m", "standard deviation of the noise"),
            plane_noise=(walls.plane_noise, "m", "standard deviation of the height of the rendered plane"),
            stiffness=(walls.stiffness, "N/m", "largest stiffness of a calm hand"),
            expected=(walls.expected, "N/m", "theory for this height"))
    s.panel("Noise of the points: a calm hand", "noise (m)", "largest stiffness (N/m)",
            [line("noise", "noise", "expected", "noise through a linear wall, derived"), dots("noise", "noise", "stiffness", "measured")])


# --- energy at frame updates ---

def resting_hand(sign, noise_m, rate_hz, shake_m, seed):
    """A hand rests 10 mm deep on a plane, at rest or shaken."""
    return "virtual-wall", {
        "scenario": {**plane(rate_hz), "noise_sigma_m": noise_m, "shake_amplitude_m": shake_m, "shake_hz": 1},
        "renderer": {"name": "proxy", "velocity_force": sign},
        "operator": {"mass_kg": 0.3, "stiffness_N_per_m": 400, "damping_Ns_per_m": 10},
        "trajectory.waypoints": [[0, 0.03, 0, 0], [0, -0.01, 0, 0.1]], "duration_s": 2.4, "seed": seed}


def draw_energies(s, over, title, x_label, axis, cases):
    """Draws and returns the energy (mJ) that the hand gets from one frame update to the next, the mean over the seeds: a row for
    each sign. axis: name, units, long name, values. cases: (noise, rate, shaking) for each value."""
    jobs = [resting_hand(sign, *each, seed) for sign in SIGNS for each in cases for seed in SEEDS]
    energy_J = np.reshape(s.measure(jobs, lambda run: run.measures["mean_energy_per_update"]), (len(SIGNS), len(cases), -1))
    energy_mJ = dict(zip(SIGNS, 1e3 * energy_J.mean(axis=2)))
    name, units, long_name, values = axis
    for sign in SIGNS:
        s.table(f"energy_{over}_{sign}", f"energy that the hand gets at a frame update, velocity_force = {sign}",
                {name: (values, units, long_name), "energy_mJ": (energy_mJ[sign], "mJ", "mean energy per update")})
    s.panel(title, x_label, "energy per update (mJ)", [
        line(f"energy_{over}_{sign}", name, "energy_mJ", f"velocity force: {sign}") for sign in SIGNS])
    return energy_mJ


# --- the figure ---

@study("device-width", "up to which stiffness a rendered plane is stable with a tool, in rotation, with other hands, frame rates and "
       "noise, and the energy that frame updates give the hand",
       title="Stable stiffness and energy of a rendered plane", source="the theory of sampled walls", caption="""
       (a) to (f): the largest stiffness at which no oscillation grows (dots) and the limit of a linear wall (line), with a tool of
       six degrees of freedom along the normal and in rotation, and with the proxy over the hand and the frame rate. (f): with a
       damper of 10 N s/m of the wall, whose velocity is measured over 5 ticks, a light hand is less stable than the law (line); the
       eigenvalues of the sampled loop give the exact limit (dashed). (g): the largest stiffness at which noise moves a resting hand
       by not more than 0.4 mm (rms). (h) to (j): energy that a resting hand gets from one frame update to the next, with each sign
       of the velocity term of (4.15). Simulated.""")
def device_width(s):
    tool_0, tool_5, turn_0, turn_5, mass, hand, rate, damper = curves = widths(s)
    draw_widths(s, [tool_0, tool_5], "A plate held flat", "damping of the device (N s/m)")
    draw_widths(s, [turn_0, turn_5], "A plate held flat, in rotation", "rotational damping of the device (N·m·s/rad)", "N·m/rad")
    draw_widths(s, [mass], "Mass of the hand", "mass (kg)")
    draw_widths(s, [hand], "Damping of the hand", "damping of the hand (N s/m)")
    draw_widths(s, [rate], "Frame rate", "frame rate (Hz)")
    draw_widths(s, [damper], "Damper of the wall, delay of 3 ms", "mass (kg)", law="(b + B) / (T / 2 + delay)")
    walls = noisy_walls(s, np.array([0.0001, 0.00025, 0.0005, 0.001]))
    draw_noise(s, walls)
    noise_m, rates_hz = [0, 0.0005, 0.001, 0.003], [15, 30, 60]
    rates = ("frame_rate", "Hz", "frame rate", rates_hz)
    draw_energies(s, "noise", "Plane at rest, 30 Hz", "noise (m)", ("noise", "m", "standard deviation of the noise", noise_m),
                  [(noise, 30, 0) for noise in noise_m])
    at_rest = draw_energies(s, "rate", "Plane at rest, noise of 1 mm", "frame rate (Hz)", rates,
                            [(0.001, hz, 0) for hz in rates_hz])
    shaken = draw_energies(s, "shaken", "Plane shaken by 10 mm at 1 Hz", "frame rate (Hz)", rates,
                           [(0, hz, 0.01) for hz in rates_hz])
    s.place_in_rows(2)

    for curve in curves[:-1]:
        s.claims(f"{curve.title}: ").at_most("the largest stable stiffness is b / (T / 2 + delay): largest relative difference",
                                             largest_error(curve.limits, "expected"), 0.05, "fraction")
    claims = s.claims(f"{damper.title}: ")
    claims.at_most("the largest stable stiffness is that of the eigenvalues: largest relative difference",
                   largest_error(damper.limits, "exact"), 0.05, "fraction")
    claims.at_least("the law (b + B) / (T / 2 + delay) is too high for the lightest hand: relative difference",
                    1 - damper.limits.stiffness[0] / damper.limits.expected[0], 0.3, "fraction")
    # Four runs of 6 s know the motion to about a tenth, and the contact may open at times.
    s.claims("noise of the points: ").at_most(
        "the largest stiffness of a calm hand is that of a linear wall: largest relative difference",
        largest_error(walls, "expected"), 0.3, "fraction")
    claims = s.claims("the velocity term of (4.15): ")
    claims.at_least("plane shaken: the printed sign gives the hand more energy than the other one: smallest excess",
                    (shaken["plus"] - shaken["minus"]).min(), 0, "mJ")
    claims.at_least("noise of 1 mm: the sign that suits a motion costs energy: smallest excess over no term",
                    (at_rest["minus"] - at_rest["none"]).min(), 0, "mJ")


def largest_error(limits, of):
    return np.abs(limits.stiffness / limits[of] - 1).max()


if __name__ == "__main__":
    sys.exit(main())
