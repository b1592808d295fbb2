"""Depth in, force out: a hand pushes a ball of the physics engine ODE, which it feels only through a depth camera.

Each camera frame the ball is seen as a depth image with the noise of a sensor; a thousand times a second the renderer computes
the force on the hand, and the ball gets the opposite one. Any engine fits here that gives depths and takes a force.

Run it (it needs python3-pyode): PYTHONPATH=build/release/python python3 runners/interfaces/python/examples/touch_a_physics_engine.py
"""
import numpy as np
import ode
import remote_touch as rt

RADIUS_M, MASS_KG = 0.05, 0.5
TICK_S, TICKS_PER_FRAME, DURATION_S = 0.001, 33, 1.0
WIDTH, HEIGHT, FOCAL_PX, CAMERA_HEIGHT_M = 320, 200, 525.0, 0.5


class Table:
    """A ball on a table, y up; metres."""

    def __init__(self):
        self.world, self.space, self.contacts = ode.World(), ode.Space(), ode.JointGroup()
        self.world.setGravity((0, -9.81, 0))
        self.floor = ode.GeomPlane(self.space, (0, 1, 0), 0)  # a space does not keep what is in it
        mass = ode.Mass()
        mass.setSphere(1, RADIUS_M)
        mass.adjust(MASS_KG)  # setSphereTotal() of pyode takes its first number as a density
        self.ball = ode.Body(self.world)
        self.ball.setMass(mass)
        self.ball.setPosition((0, RADIUS_M, 0))
        self.shape = ode.GeomSphere(self.space, RADIUS_M)
        self.shape.setBody(self.ball)

    def advance(self, force_N, at_m):
        self.ball.addForceAtPos([float(f) for f in force_N], [float(p) for p in at_m])
        self.space.collide(None, self.touch)
        self.world.step(TICK_S)
        self.contacts.empty()

    def touch(self, _, one, other):
        for contact in ode.collide(one, other):
            contact.setMu(1.0)
            ode.ContactJoint(self.world, self.contacts, contact).attach(one.getBody(), other.getBody())

    def place_m(self):
        return np.array(self.ball.getPosition())


# A ray for each pixel, of a camera that looks straight down: its columns go along x, its rows along z.
columns, rows = np.meshgrid(np.arange(WIDTH), np.arange(HEIGHT))
RAYS = np.stack([(columns - (WIDTH - 1) / 2) / FOCAL_PX, -np.ones_like(columns, dtype=float), (rows - (HEIGHT - 1) / 2) / FOCAL_PX], axis=-1)
EYE_M = np.array([0.02, CAMERA_HEIGHT_M, 0])


def depth_image(ball_m):
    """Of each pixel the depth of the ball or of the table, and the cosine between ray and normal."""
    from_ball = EYE_M - ball_m
    a, b, c = (RAYS**2).sum(axis=-1), RAYS @ from_ball, from_ball @ from_ball - RADIUS_M**2
    hits = b**2 > a * c
    depth_m = np.where(hits, (-b - np.sqrt(np.where(hits, b**2 - a * c, 0))) / a, CAMERA_HEIGHT_M)
    normals = np.where(hits[..., None], from_ball + depth_m[..., None] * RAYS, [0, 1, 0])
    cosine = -(normals * RAYS).sum(axis=-1) / np.linalg.norm(normals, axis=-1) / np.sqrt(a)
    return depth_m, cosine


def hand_m(time_s):
    """Comes down behind the ball in half a second, and pushes it with 0.2 m/s."""
    return np.array([-0.08 + 0.2 * max(0, time_s - 0.5), 0.12 - 0.05 * min(1, 2 * time_s), 0])


def main():
    table = Table()
    camera = rt.DepthSensor(sensor="structured-light", width=WIDTH, height=HEIGHT, focal_px=FOCAL_PX)
    hand = rt.stepper("proxy", {"stiffness_N_per_m": 300})
    largest_N = 0.0
    for tick in range(round(DURATION_S / TICK_S)):
        time_s = tick * TICK_S
        if tick % TICKS_PER_FRAME == 0:
            measured_m, = camera.measured(*depth_image(table.place_m()), frames=[tick // TICKS_PER_FRAME])
            points = EYE_M + measured_m[..., None] * RAYS  # NaN where the sensor measured nothing
            hand.frame(rt.Cloud(points.reshape(-1, 3), columns=WIDTH), time_s)
        felt = hand.step(hand_m(time_s), time_s)
        is_ball = np.linalg.norm(felt.proxy_m - table.place_m()) < 1.5 * RADIUS_M  # and not the table
        table.advance(-felt.force_N if is_ball else np.zeros(3), felt.proxy_m)
        largest_N = max(largest_N, np.linalg.norm(felt.force_N))
    moved_mm = 1000 * table.place_m()[0]
    print(f"the hand pushed with up to {largest_N:.2f} N, and the ball rolled {moved_mm:.0f} mm")


if __name__ == "__main__":
    main()
