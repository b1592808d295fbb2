"""Own noise model: a flat surface whose noise grows with the distance from the middle of the image, pressed by the proxy.

Run it: PYTHONPATH=build/release/python python3 runners/interfaces/python/examples/own_noise.py
"""
import numpy as np
import remote_touch as rt


@rt.register("vignetted-lift")
class VignettedLift(rt.Scenario):
    """The rising surface of figure 4.12 with noise that grows towards the border of the image."""

    settings = {
        "sigma_m": rt.Setting(0.001, low=0, high=0.02, help="standard deviation in the middle"),
        "growth_per_m": rt.Setting(20.0, low=0, high=1000, help="relative increase of it with the distance"),
    }

    def __init__(self):
        self.clean = rt.scene("moving-lift", noise_sigma_m=0, acceleration_m_per_s2=1)
        self.frame_rate_hz = self.clean.frame_rate_hz
        self.frame_count = 2**28 - 1  # the most: each frame has new noise, also when the surface rests

    def cloud(self, frame):
        points = self.clean.cloud(min(frame, self.clean.frame_count - 1)).points
        # Of the key (seed, cell, replicate) and the frame alone: equal seeds give equal bits, in any order.
        normals = self.key.normals("point_position", frame, len(points))
        distance_m = np.hypot(points[:, 0], points[:, 2])
        return points + (self.sigma_m * (1 + self.growth_per_m * distance_m))[:, None] * normals

    def signed_distance(self, p, time_s):
        return self.clean.signed_distance(p, time_s)

    def surface_height(self, x, z, time_s):
        return self.clean.surface_height(x, z, time_s)


def main():
    experiment = {
        "scenario": {"name": "vignetted-lift"},
        "renderer": {"name": "proxy", "steps_per_tick": 30},
        "trajectory": {"name": "press", "press_at_s": 0.3, "depth_m": 0.01},
        "duration_s": 0.6,
    }
    for sigma_m in (0, 0.001, 0.002):
        run = rt.run(experiment, seed=7, set={"scenario.sigma_m": sigma_m})
        noise_N = float(run.force.sel(xyz="y")[run.time > 0.45].std())
        print(f"sigma {1e3 * sigma_m:.0f} mm: force changes by {noise_N:.3f} N, digest {run.attrs['digest'][:12]}")
    again = rt.run(experiment, seed=7, set={"scenario.sigma_m": 0.002})
    print("the same seed again:", "the same bits" if rt.compare(run, again).same else "OTHER BITS")


if __name__ == "__main__":
    main()
