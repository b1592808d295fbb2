"""All quantities that are stored, in the order of the stored files. A new one is one line of QUANTITIES."""
import dataclasses
from typing import Optional, Union

# The names of instruction sets, and those of the levels in names of benchmarks.
LEVELS = {"AVX-512": "x86-64-v4", "AVX2": "x86-64-v3", "SSE2": "x86-64"}
ANY = "any"
UNITS_NS = {"ns": 1, "us": 1e3, "ms": 1e6, "s": 1e9}
TIMES = "times"
# Each part, with the program that measures it, its largest number of repetitions and the least seconds of one. A slide
# of the tool takes a second where the points are many: shorter, and it would end in its beginning.
PARTS = {"proxy": ("proxy_benchmark", 99, 0), "map": ("map_benchmark", 2, 0), "depth": ("depth_benchmark", 99, 0),
         "tool": ("tool_benchmark", 3, 0.2), "spheres": ("sphere_tree_benchmark", 3, 0.5),
         "search_peers": ("peer_search_benchmark", 99, 0), "depth_peers": ("peer_depth_benchmark", 99, 0),
         "tool_peers": ("peer_tool_benchmark", 99, 0)}


@dataclasses.dataclass(frozen=True)
class Quantity:
    part: str
    text: str  # it never changes its meaning
    unit: str
    name: str  # of the benchmark; {level} stands for each instruction set
    aim: Union[str, dict, None] = None  # "<= 2" or ">= 2", or one for each instruction set
    over: Optional[str] = None  # the benchmark that a ratio is relative to
    source: str = "cpu"  # "cpu" or "wall" time, or a counter in ns
    factor: float = 1

    def instructions(self):
        return list(LEVELS) if "{level}" in self.name + (self.over or "") else [ANY]

    def value(self, times, instructions):
        """The number with three digits, or None if it was not measured."""
        def read(name, source):
            return times.get(name.format(level=LEVELS.get(instructions)), source)
        value, unit = read(self.name, self.source), read(self.over, "cpu") if self.over else UNITS_NS[self.unit]
        return None if value is None or unit is None else f"{float(f'{self.factor * value / unit:.3g}'):g}"

    def aim_of(self, instructions):
        return (self.aim.get(instructions) if isinstance(self.aim, dict) else self.aim) or ""

    def met(self, number, instructions):
        if not self.aim_of(instructions):
            return ""
        relation, bound = self.aim_of(instructions).split()
        return "yes" if (number <= float(bound) if relation == "<=" else number >= float(bound)) else "no"


def relative(part, text, name, over, aim=None, factor=1):
    return Quantity(part, text, TIMES, name, aim, over, factor=factor)


QUANTITIES = [
    Quantity("proxy", "proxy step with its search, 105 points", "ns", "step/{level}", {"AVX-512": "<= 200", "AVX2": "<= 300"}),
    relative("proxy", "proxy step, written plainly over all 100 x 100 points", "step_naive", "step/{level}",
             {"AVX-512": ">= 150", "AVX2": ">= 150"}),
    Quantity("proxy", "proxy tick in contact, 30 steps of gamma 0.3", "us", "tick_of_30_steps/{level}"),
    *[relative("proxy", f"proxy tick, {steps} of gamma {gamma}, relative to 30 steps of gamma 0.3",
               f"tick_of_{steps.replace(' ', '_')}/{{level}}", "tick_of_30_steps/{level}")
      for steps, gamma in (("10 steps", "0.3"), ("8 steps", "0.5"))],
    *[quantity for rows, aim in ((6, "<= 0.3"), (50, "<= 1.2")) for quantity in (
        Quantity("proxy", f"quadratic program of 6 variables, {rows} rows", "us", f"program_ours/{rows}", aim),
        relative("proxy", f"quadratic program, {rows} rows, by NLopt's SLSQP", f"program_nlopt/{rows}", f"program_ours/{rows}"))],

    Quantity("map", "sweep of 5396 lifts (figure 4.13, 30 steps per frame), one core", "s", "map/1/{level}", "<= 6"),
    relative("map", "sweep, written plainly with noise of the standard library", "map_plain_12_lifts", "map/1/{level}", ">= 60", 5396 / 12),
    Quantity("map", "sweep, two cores, wall-clock time", "s", "map/2/{level}", "<= 3.5", source="wall"),

    Quantity("depth", "filter and normals, 640 x 480 pixels, one core", "ms", "depth_frame/1/{level}",
             {"AVX-512": "<= 12", "AVX2": "<= 22"}),
    relative("depth", "filter and normals, written plainly in double", "depth_plain", "depth_frame/1/{level}"),
    Quantity("depth", "filter and normals, two cores, wall-clock time", "ms", "depth_frame/2/{level}", {"AVX-512": "<= 6.5"}, source="wall"),

    *[quantity for where, text, aim in (
        ("contact", "touching", {"AVX-512": "<= 2.5", "SSE2": "<= 6"}), ("separated", "clear", {"AVX-512": "<= 0.1", "SSE2": "<= 0.1"}))
      for quantity in (
          Quantity("tool", f"collision list, 2500 points, {text}", "us", f"tool_list/2500_{where}/{{level}}", aim),
          relative("tool", f"collision list, {text}, written plainly", f"tool_list_naive/2500_{where}", f"tool_list/2500_{where}/{{level}}"))],
    *[Quantity("tool", f"{rule} tick, p99.9: {text}", "ms", f"tool_tick/{cloud}_{rule}/{{level}}", "<= 0.3", source="p99_9_ns")
      for cloud, text in (("2500", "dog, 2500 points, 2 mm"), ("40000", "dog, 40 000 points, 1 mm"),
                          ("111556", "dog, 111 556 points, 0.3 mm"), ("111556_slab", "flat block, 111 556 points, 0.3 mm"))
      for rule in ("look-ahead", "continuous") if (cloud, rule) != ("111556_slab", "continuous")],

    Quantity("spheres", "tree of 3714 regions of a 640 x 480 frame", "ms", "region_tree/wheels", "<= 2"),
    *[relative("spheres", f"detection of 112 leaves, {text}, by every pair of leaves", f"region_contacts_naive/{where}",
               f"region_contacts/{where}/{{level}}")
      for where, text in (("clear", "clear of the regions"), ("touching", "touching"), ("deep", "30 mm deep"))],
    *[Quantity("spheres", f"tick of 112 leaves, p99.9: {tool}, {text}", "us", f"region_tick/{tool}_{course}/{{level}}", "<= 500", source="p99_9_ns")
      for course, text in (("slide", "slide around the valves"), ("swallowed", "regions 30 mm nearer in every other frame"))
      for tool in ("key", "husky")],

    *[relative("search_peers", f"radius query of 81 points by {text}", f"query/{peer}", "query/ours/{level}", aim)
      for peer, text, aim in (("pcl_organized_neighbor", "PCL's OrganizedNeighbor", ">= 4"),
                              ("pcl_kdtree_flann", "PCL's k-d tree", ">= 20"), ("nanoflann_leaf_40", "nanoflann", None))],
    *[relative("depth_peers", f"normals by {text}, relative to filter and normals", f"normals/{peer}", "normals/ours/{level}", aim)
      for peer, text, aim in (("pcl_covariance", "PCL's covariance integral image", ">= 4"),
                              ("pcl_normal_estimation_omp", "PCL's NormalEstimationOMP", ">= 20"),
                              ("opencv_fals_5", "OpenCV's FALS, window 5", ">= 0.25"),
                              ("opencv_fals_7", "OpenCV's FALS, window 7", ">= 0.25"))],
    *[relative("tool_peers", f"collision list of 2500 points by {text}, {pose}", f"list/{where}/{peer}", f"list/{where}/ours/{{level}}", aim)
      for where, pose in (("contact", "touching"), ("pressed", "2 mm deeper"))
      for peer, text, aim in (("fcl_octree", "FCL's octree", ">= 200"),
                              ("bullet_gimpact_0.5mm", "Bullet's GImpact, triangles of 0.5 mm", ">= 100"),
                              ("bullet_gimpact_2mm", "Bullet's GImpact, triangles of 2 mm", ">= 100"))],
]
