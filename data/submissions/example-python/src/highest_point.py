"""A spring out of the highest point near the hand, from above."""
import numpy as np
import remote_touch as rt


@rt.register("highest-point")
class HighestPoint(rt.Renderer):
    """A spring out of the highest point near the hand."""

    settings = {"stiffness_N_per_m": rt.Setting(500.0, low=0, high=1e4, help="of the spring"),
                "radius_m": rt.Setting(0.01, low=0.001, high=0.1, help="points so far from the hand, sideways, count")}

    def __init__(self):
        self.points = np.empty((0, 3))

    def on_frame(self, frame):
        points = frame.points
        self.points = points[np.isfinite(points[:, 0])]

    def step(self, device, time_s):
        hip = device.position_m
        near = self.points[np.hypot(self.points[:, 0] - hip[0], self.points[:, 2] - hip[2]) < self.radius_m]
        depth_m = near[:, 1].max() - hip[1] if len(near) else 0
        if depth_m <= 0:
            return rt.Output()
        return rt.Output(force_N=(0, self.stiffness_N_per_m * depth_m, 0), normal=(0, 1, 0), state="contact", proxy_m=hip + (0, depth_m, 0))

    def rest_distance_m(self):
        return 0.0
