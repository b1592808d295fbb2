"""Force and torque of the methods for tools against model scenes in which they are known exactly, in magnitude and direction:
the protocol of Weller et al. 2010."""
import collections
import sys

import numpy as np

from remote_touch import theory
from remote_touch.studies import dashed, line, main, study

STIFFNESS_N_PER_M = 600  # k of the coupling of all methods, and the default of the closed forms
PENALTY_STIFFNESS_N_PER_M, PENALTY_POINTS = 2400, 10  # k_p of the penalty method, and its points in contact
BLOCK_HALF_M, BLOCK_HALF_HEIGHT_M = 0.02, 0.005  # of slab-10
BALL_RADIUS_M = 0.01  # of ball
BAR_HALF_M, BAR_HALF_HEIGHT_M, SLOT_HALF_M = 0.04, 0.005, 0.02  # of bar, and of the scene slot
ABOVE_M, DEEP_M = 0.002, 0.006  # a press starts above the touch and ends below it
SMALL_FORCE_N, SMALL_TORQUE_NM = 0.5, 0.005  # a tick counts if the exact vector is longer
GAP = 0.02  # the continuous rule and the god-object keep a gap of 0.05 mm, which is 1.7 % of the mean depth of a press
ERRORS, ANGLES_DEG = (1e-5, 10), (1e-4, 100)  # ranges of the axes; smaller deviations are marked below them

METHODS = {  # column: label and renderer
    "look_ahead": ("look-ahead", {"name": "tool"}),
    "continuous": ("continuous", {"name": "tool", "contact_rule": "continuous"}),
    "voxels": ("as printed", {"name": "tool", "contact_rule": "voxels"}),
    "god_object": ("god-object", {"name": "tool-god-object"}),
    "penalty": ("penalty", {"name": "tool-penalty"}),
    "voxmap": ("voxmap", {"name": "tool-penalty", "force_law": "voxmap"})}
OF_COUPLING = {"look_ahead": ("look-ahead, M of the coupling", {"name": "tool", "motion_metric": "coupling"})}
RELATIVE, ANGLE = ": largest relative deviation", ": largest angle to it"  # ends of claims

# Presses at several settings, and their table. press_of: the Press of a setting (deg).
Scene = collections.namedtuple("Scene", "table title setting meaning press_of settings_deg")
# A press of a tool. wrench(run): the exact force (N) and torque (N m) on the hand, with a row for each tick.
Press = collections.namedtuple("Press", "tool scenario poses wrench")


def press_along(touching_m, normal, about_z_deg=0):
    """The poses of a press along a normal, by the place at which the tool touches. Numbers have six digits."""
    ends = touching_m + np.outer((ABOVE_M, -DEEP_M), normal)
    return [[*(float(f"{number:.6g}") for number in place), 0, 0, about_z_deg, at_s] for place, at_s in zip(ends, (0, 0.4))]


def surface(**shape):
    return {"name": "moving-shape", "columns": 70, "rows": 50, "phase_x": 0.37, "phase_z": 0.21, "normals": True, **shape}


def angle_rad(run, axis):
    """The rotation of the device, which is about one axis only."""
    return 2 * np.arctan2(run.hip_orientation[:, 1 + axis], run.hip_orientation[:, 0])


def about(axis, torque_Nm):
    return np.outer(torque_Nm, np.eye(3)[axis])


def in_plane(wrenches):
    """Forces along x and y and torques about z, in space."""
    forces, torques = map(np.array, zip(*wrenches))
    return np.column_stack([forces, np.zeros(len(forces))]), about(2, torques)


def on_plane(tilt_deg):
    """A block with the tilt of the plane, pressed along its normal by d: the exact force is k d, the exact torque 0."""
    tilt = np.radians(tilt_deg)
    normal = np.array([-np.sin(tilt), np.cos(tilt), 0])

    def wrench(run):
        depth_m = np.maximum(0, BLOCK_HALF_HEIGHT_M - run.hip_position @ normal)
        return STIFFNESS_N_PER_M * np.outer(depth_m, normal), np.zeros((len(run), 3))
    return Press("slab-10", surface(tilt_deg=tilt_deg), press_along(BLOCK_HALF_HEIGHT_M * normal, normal, tilt_deg), wrench)


def turned_block(turn_deg):
    """A block on a level plane, turned by the hand."""
    turn = np.radians(turn_deg)
    touching_m = BLOCK_HALF_M * np.sin(turn) + BLOCK_HALF_HEIGHT_M * np.cos(turn)
    return Press("slab-10", surface(tilt_deg=0), press_along((0, touching_m, 0), (0, 1, 0), turn_deg),
                 lambda run: in_plane([theory.block_on_line(BLOCK_HALF_M, BLOCK_HALF_HEIGHT_M, height_m, angle)
                                       for height_m, angle in zip(run.hip_position[:, 1], angle_rad(run, 2))]))


def in_groove(slope_deg):
    """A ball pressed into a valley, 2 mm beside its middle."""
    slope = np.radians(slope_deg)
    touching_m = (0.002, BALL_RADIUS_M / np.cos(slope), 0)
    return Press("ball", surface(shape="valley", slope_deg=slope_deg), press_along(touching_m, (0, 1, 0)),
                 lambda run: in_plane([theory.ball_in_groove(BALL_RADIUS_M, slope, at_m) for at_m in run.hip_position[:, :2]]))


def in_slot():
    """A bar turned by 32 degrees between two walls: the exact force is 0, the exact torque that of two corners of the bar."""
    def wrench(run):
        torques_Nm = [theory.bar_in_slot(BAR_HALF_M, BAR_HALF_HEIGHT_M, SLOT_HALF_M, angle)[1] for angle in angle_rad(run, 1)]
        return np.zeros((len(run), 3)), about(1, torques_Nm)
    return Press("bar", {"name": "slot", "spacing_m": 0.002}, [[0] * 7, [0, 0, 0, 0, 32, 0, 0.5]], wrench)


def task(press, renderer):
    return {"title": "tool-forces", "scenario": press.scenario, "renderer": {**renderer, "tool_mesh": press.tool},
            "trajectory": {"name": "poses", "poses": press.poses}}


def deviation(rendered, exact, small):
    """Over the ticks in which the exact vector is not small: the mean deviation of the magnitude as a fraction of the mean exact
    magnitude; the fraction without any vector; the mean angle (deg) between both in the others. NaN without such ticks."""
    size = np.linalg.norm(exact, axis=1)
    counts = size > small
    rendered, exact, size = rendered[counts], exact[counts], size[counts]
    got = np.linalg.norm(rendered, axis=1)
    angles = np.arctan2(np.linalg.norm(np.cross(exact, rendered), axis=1), np.sum(exact * rendered, axis=1))[got > 0]
    with np.errstate(invalid="ignore"):  # 0 / 0
        return (np.abs(got - size).sum() / size.sum(), np.sum(got == 0) / np.float64(size.size),
                np.degrees(angles.sum() / np.float64(angles.size)))


def deviations(run, press):
    """A row of add_deviations() for a method."""
    force_N, torque_Nm = press.wrench(run)
    of_torque, _, of_direction = deviation(run.torque, torque_Nm, SMALL_TORQUE_NM)
    return [*deviation(run.force, force_N, SMALL_FORCE_N), of_torque, of_direction,
            np.linalg.norm(run.torque - torque_Nm, axis=1).mean()]


def add_deviations(s, scene, methods=METHODS):
    """Presses at each setting by each method; adds the table of the deviations, and returns it."""
    runs = s.grid({"method": [*methods], "setting": scene.settings_deg},
                  lambda cell: (task(scene.press_of(cell.setting), methods[cell.method][1]), None),
                  {"deviations": lambda run, cell: deviations(run, scene.press_of(cell.setting))})
    columns = {scene.setting: (scene.settings_deg, "deg", scene.meaning)}
    for method in methods:
        force, missing, direction, torque, torque_direction, torque_error = runs.where(method=method).deviations.T
        columns |= {f"{method}_force": (force, "1", "mean deviation of |force|, fraction"),
                    f"{method}_force_missing": (missing, "1", "fraction of ticks without a force"),
                    f"{method}_force_direction": (direction, "deg", "mean angle to the exact force, where there is one"),
                    f"{method}_torque": (torque, "1", "mean deviation of |torque|, fraction; NaN where none is exact"),
                    f"{method}_torque_direction": (torque_direction, "deg", "mean angle to the exact torque, where there is one"),
                    f"{method}_torque_error": (torque_error, "N m", "mean of |torque - exact torque|")}
    return s.table(scene.table, scene.title, columns)


def draw(s, scene, title, quantity, x_label, more_curves=()):
    """A panel of a quantity, which is a suffix of columns, with a logarithmic axis."""
    is_angle = quantity.endswith("direction")
    s.panel(title, x_label, "angle to the exact force (deg)" if is_angle else f"relative error of {quantity}",
            [*(line(scene.table, scene.setting, f"{method}_{quantity}", label) for method, (label, _) in METHODS.items()),
             *more_curves], y_range=ANGLES_DEG if is_angle else ERRORS)


def add_slot(s):
    """The torque about y of a bar turned between two walls, over the angle of the device; the signs are those of a push back."""
    press = in_slot()
    runs = s.runs([task(press, renderer) for _, renderer in METHODS.values()])
    exact_Nm = -press.wrench(runs[0])[1][:, 1]
    columns = {"angle": (np.degrees(angle_rad(runs[0], 1)), "deg", "angle of the device"),
               "exact": (exact_Nm, "N m", "closed form")}
    for (method, (label, _)), run in zip(METHODS.items(), runs):
        torque_Nm = -run.torque[:, 1]
        columns |= {method: (torque_Nm, "N m", f"torque, {label}"),
                    f"{method}_error": (torque_Nm - exact_Nm, "N m", "torque - exact torque")}
    return s.table("slot", "A bar turned between two walls: torque", columns)


def draw_slot(s):
    """The walls stop the bar at 22.6 deg."""
    s.panel("Bar turned between two walls: torque", "angle of the device (deg)", "torque - exact torque (N m)",
            [line("slot", "angle", f"{method}_error", label) for method, (label, _) in METHODS.items()], x_range=(20, 32))


@study("tool-forces", "force and torque of a tool by six methods, against scenes where they are known",
       title="Force and torque of a tool against model scenes", caption="""
       Presses of 6 mm in 0.4 s in which force and torque are known in closed form: a block of 40 x 10 mm on a plane that is tilted
       as the block is, and on a level plane where the hand tilts the block; a ball of 10 mm in a valley; a bar between two walls.
       Mean deviation from the closed form of magnitude and direction over the ticks with a force of 0.5 N or more; points 1.5 mm
       apart (slot: 2 mm), no noise; simulated. The axes of errors and angles are logarithmic. Errors below 0.00001 and
       angles below 0.0001 deg are marked below the axis. Protocol: Weller et al. 2010.""")
def tool_forces(s):
    tilted = Scene("planes", "A block on a tilted plane", "tilt", "tilt of plane and block", on_plane, [0, 5, 10, 20, 30, 40])
    turned = Scene("blocks", "A tilted block on a level plane", "turn", "turn of the block, by the hand", turned_block,
                   [2, 4, 7, 10, 15, 20])
    valley = Scene("grooves", "A ball in a valley", "slope", "slope of both sides", in_groove, [15, 30, 45])
    planes, blocks, grooves = (add_deviations(s, scene) for scene in (tilted, turned, valley))
    slot = add_slot(s)
    of_coupling = add_deviations(s, turned._replace(table="of_coupling", title="A tilted block, M of the coupling"), OF_COUPLING)

    draw(s, tilted, "Block on a tilted plane: force", "force", "tilt (deg)")
    draw(s, tilted, "Block on a tilted plane: direction", "force_direction", "tilt (deg)")
    for quantity in ("force", "torque"):
        draw(s, turned, f"Tilted block on a level plane: {quantity}", quantity, "tilt by the hand (deg)",
             [dashed("of_coupling", "turn", f"look_ahead_{quantity}", OF_COUPLING["look_ahead"][0])])
    draw(s, valley, "Ball in a valley: direction", "force_direction", "slope (deg)")
    draw_slot(s)
    s.place_in_rows(2)

    claim_planes(s, planes)
    claim_blocks(s.claims("with a tilted block, "), blocks, of_coupling)
    claim_grooves(s.claims("in a valley, "), grooves)
    claim_slot(s.claims(), slot)


def claim_planes(s, planes):
    """The points of the penalty method are springs in series with the coupling."""
    claims = s.claims("on a tilted plane, ")
    claims.at_most("look-ahead gives the exact force" + RELATIVE, planes.look_ahead_force.max(), 1e-3)
    claims.at_most("look-ahead gives the exact direction of the force" + ANGLE,
                   planes.look_ahead_force_direction.max(), 0.01, "deg")
    claims.at_most("the continuous rule gives nearly the exact force" + RELATIVE, planes.continuous_force.max(), GAP)
    claims.at_most("the god-object gives nearly the exact force" + RELATIVE, planes.god_object_force.max(), GAP)
    claims.at_most("the god-object gives the exact direction of the force" + ANGLE,
                   planes.god_object_force_direction.max(), 0.01, "deg")
    claims.at_most("the printed rule gives the exact force" + RELATIVE, planes.voxels_force.max(), 0.01)
    sinks = STIFFNESS_N_PER_M / (STIFFNESS_N_PER_M + PENALTY_POINTS * PENALTY_STIFFNESS_N_PER_M)
    s.claims("on a level plane, ").between("the force of the penalty method is too small by k / (k + 10 k_p): relative deviation",
                                           planes.penalty_force[0], 0.9 * sinks, 1.1 * sinks)
    claims.at_least("the steps of voxmap turn the force: largest angle to the exact one",
                    planes.voxmap_force_direction.max(), 5, "deg")


def claim_blocks(claims, blocks, of_coupling):
    """The torque at a corner must be that of the force. The constrained motion (6.4) ends when the contacts hold the remaining
    displacement, multiplied by M. The coupling exerts on the hand k times that displacement, and k r^2 times the angle. Both agree
    if M is that of the coupling."""
    claims.at_most("the god-object with M of the coupling gives nearly the exact force" + RELATIVE,
                   blocks.god_object_force.max(), GAP)
    claims.at_most("the god-object with M of the coupling gives nearly the exact torque" + RELATIVE,
                   blocks.god_object_torque.max(), GAP)
    claims.at_least("look-ahead with M of the tool gives a wrong torque" + RELATIVE, blocks.look_ahead_torque.max(), 1)
    claims.at_least("the printed rule with M of the tool gives a wrong torque" + RELATIVE, blocks.voxels_torque.max(), 1)
    for quantity in ("force", "torque"):
        claims.at_most(f"look-ahead with M of the coupling gives the exact {quantity}" + RELATIVE,
                       of_coupling[f"look_ahead_{quantity}"].max(), 0.01)


def claim_grooves(claims, grooves):
    claims.at_most("look-ahead gives nearly the exact force" + RELATIVE, grooves.look_ahead_force.max(), GAP)
    claims.at_most("the god-object gives nearly the exact force" + RELATIVE, grooves.god_object_force.max(), 2 * GAP)
    claims.at_most("look-ahead gives the exact direction of the force" + ANGLE,
                   grooves.look_ahead_force_direction.max(), 0.5, "deg")
    claims.at_most("look-ahead gives a force in every tick: largest fraction of ticks without one",
                   grooves.look_ahead_force_missing.max(), 0)
    claims.at_most("the god-object gives a force in nearly every tick: largest fraction of ticks without one",
                   grooves.god_object_force_missing.max(), 0.02)
    claims.at_most("the god-object gives nearly the exact direction of the force" + ANGLE,
                   grooves.god_object_force_direction.max(), 2, "deg")
    claims.at_least("voxmap turns the force: largest angle to the exact one", grooves.voxmap_force_direction.max(), 5, "deg")


def claim_slot(claims, slot):
    for method, column, limit_Nm in (("look-ahead", "look_ahead", 1e-3), ("the continuous rule", "continuous", 1e-3),
                                     ("the god-object", "god_object", 1e-3), ("the printed rule", "voxels", 0.01)):
        claims.at_most(f"{method} gives the exact torque of a bar in a slot at 32 degrees: error",
                       abs(slot[f"{column}_error"][-1]), limit_Nm, "N m")


if __name__ == "__main__":
    sys.exit(main())
