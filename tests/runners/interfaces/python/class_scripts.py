"""What scripts with classes of Python begin with."""

COMMON = '''
import json, sys
import numpy as np
import remote_touch as rt
PRESS = {"scenario": {"name": "moving-lift", "noise_sigma_m": 0.001}, "renderer": {"name": "proxy"},
         "trajectory": {"name": "press", "press_at_s": 0.05, "depth_m": 0.004}, "duration_s": 0.2}
'''

# The penalty method from its equations, by brute force: (4.1), (4.2), (5.5).
PENALTY = COMMON + '''
class Penalty(rt.Renderer):
    """A spring out of the nearest point."""
    contact_model = "nothing"
    settings = {"stiffness_N_per_m": rt.Setting(600, low=0, high=1e4, help="of the spring", live=True),
                "contact_radius_m": rt.Setting(0.005, low=1e-6, high=1), "r3_m": rt.Setting(0.01, low=1e-6, high=1)}

    def __init__(self):
        self.points, self.normal = None, np.zeros(3)

    def validate(self):
        return None if self.contact_radius_m < self.r3_m else f"contact_radius_m = {self.contact_radius_m}: expected below r3_m"

    def on_frame(self, frame):
        self.points = frame.points

    def step(self, device, time_s):
        hip = device.position_m
        away = hip - self.points
        r = np.sqrt((away ** 2).sum(1))
        near = r <= self.r3_m
        t = np.clip((r[near] - self.contact_radius_m) / (self.r3_m - self.contact_radius_m), 0, 1)
        total = (away[near] * ((1 - t) ** 4 * (4 * t + 1) / r[near])[:, None]).sum(0)
        if np.linalg.norm(total) > 0:
            self.normal = total / np.linalg.norm(total)
        depth = self.contact_radius_m - r.min()
        force = max(self.stiffness_N_per_m * depth, 0) * self.normal if depth > 0 else np.zeros(3)
        return rt.Output(force_N=force, slave_m=hip, normal=self.normal, state="contact" if depth > 0 else "free",
                         nearest_distance_m=r.min() if near.any() else np.inf, steps=1, converged=True,
                         contact_count=int((r <= self.contact_radius_m).sum()))

    def rest_distance_m(self):
        return self.contact_radius_m

    def spring_N_per_m(self):
        return self.stiffness_N_per_m

rt.register(Penalty, "python-penalty")
'''
