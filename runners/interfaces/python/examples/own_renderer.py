"""Own renderer against the proxy on a map: a ball on the plane that fits the points near the hand.

Run it: PYTHONPATH=build/release/python python3 runners/interfaces/python/examples/own_renderer.py
"""
import numpy as np
import remote_touch as rt


@rt.register("fitted-plane")
class FittedPlane(rt.Renderer):
    """A ball on the plane that fits the points around the HIP best, from above."""

    settings = {
        "stiffness_N_per_m": rt.Setting(500.0, low=0, high=1e4, help="of the spring", live=True),
        "contact_radius_m": rt.Setting(0.005, low=0, high=0.1, help="of the ball"),
        "window_m": rt.Setting(0.02, low=0.001, high=0.1, help="points so far from the HIP, sideways, count"),
    }

    def __init__(self):
        self.captured_s = -np.inf
        self.points = np.empty((0, 3))

    def on_frame(self, frame):
        if frame.captured_s > self.captured_s:
            self.captured_s = frame.captured_s
            points = frame.points
            self.points = points[np.isfinite(points[:, 0])]

    def step(self, device, time_s):
        hip = device.position_m
        near = self.points[np.hypot(self.points[:, 0] - hip[0], self.points[:, 2] - hip[2]) < self.window_m]
        if len(near) < 10:
            return rt.Output(status="no_frame")
        # y = a + b dx + c dz, by least squares
        sides = np.column_stack([np.ones(len(near)), near[:, 0] - hip[0], near[:, 2] - hip[2]])
        a, b, c = np.linalg.lstsq(sides, near[:, 1], rcond=None)[0]
        normal = np.array([-b, 1, -c]) / np.sqrt(1 + b * b + c * c)
        depth = self.contact_radius_m + (a - hip[1]) * normal[1]  # of the ball at the HIP
        if depth <= 0:
            return rt.Output(normal=normal, nearest_distance_m=self.contact_radius_m - depth)
        return rt.Output(proxy_m=hip + depth * normal, force_N=self.stiffness_N_per_m * depth * normal,
                         normal=normal, state="contact", nearest_distance_m=self.contact_radius_m,
                         contact_count=len(near))

    def rest_distance_m(self):
        return self.contact_radius_m


def pop_through_map(renderer, noise_m, acceleration_m_per_s2):
    """The fraction of lifts of figure 4.12 that end on the wrong side of the surface."""
    return rt.sweep({
        "title": "lifts",
        "experiment": "fig4.12",
        "set": {"renderer": renderer, "duration_s": 0.7},
        "axes": [{"parameter": "scenario.noise_sigma_m", "values": noise_m},
                 {"parameter": "scenario.acceleration_m_per_s2", "values": acceleration_m_per_s2}],
        "replicates": 2,
        "measures": ["popped_through", "rms_surface_error"],
    })


def main(noise_m=(0.0, 0.003), acceleration_m_per_s2=(1.0, 4.0, 16.0)):
    print("fraction of lifts that popped through")
    for renderer in ({"name": "proxy"}, {"name": "fitted-plane"}):
        lifts = pop_through_map(renderer, [*noise_m], [*acceleration_m_per_s2])
        print(f"\n{renderer['name']}")
        print(lifts.popped_through.mean("replicate").to_pandas())


if __name__ == "__main__":
    main()
