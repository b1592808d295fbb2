"""Tables of the depth pipeline, of meshes and of bags on the terminal."""
from benchmarks.aims import *
from benchmarks.printing import show, table

TRADE_KINDS = ("plane", "crease", "limb", "all")


def print_depth(times):
    plain = times.ns.get("depth_plain")
    rows = []
    for what, kind in (("filter and normals", "depth_frame"), ("normals", "depth_normals"),
                       ("filter and normals, 2500 points", "depth_region")):
        for threads in (1, 2):
            for level in LEVELS:
                name = f"{kind}/{threads}/{level}"
                if name not in times.ns:
                    continue
                ns = (times.ns if threads == 1 else times.wall_ns)[name]
                asked = ASKED_DEPTH_MS.get((threads, level)) if kind == "depth_frame" else None
                rows.append([f"{what}, {level}", threads, asked or "", f"{ns / 1e6:.2f}",
                             f"{ns / 1e6 / asked:.2f}" if asked else "",
                             f"{plain / ns:.0f}" if plain and kind == "depth_frame" and threads == 1 else ""])
    table("Depth image of 640x480 pixels into a cloud, 9x9 each, ms; plain: in double, "
          f"{show(plain / 1e6) if plain else '-'} ms",
          ["", "threads", "asked <=", "measured", "ratio", "x plain"], rows)


def print_depth_peers(peers):
    """Normals beside ours at the best level of the machine. raw: as measured; filtered: given our filtered points."""
    def best(group):
        names = [f"{group}/ours/{level}" for level in LEVELS if f"{group}/ours/{level}" in peers.ns]
        return names[-1]

    both = best("both")
    rows = []
    for name, ns in peers.ns.items():
        group, peer = name.split("/", 1)
        if group not in ("raw", "filtered") or peer.startswith("ours"):
            continue
        deg, ours_deg = (peers.counters[each]["rms_deg"] for each in (name, both))
        times_ours = ns / peers.ns[both]
        asked = ASKED_OF_DEPTH_PEERS.get(peer) if group == "raw" else None
        asked_time, asked_error = ASKED_OF_FALS.get(peer, ("", "")) if group == "raw" else ("", "")
        rows.append([f"{peer}, {group}", f"{ns / 1e6:.1f}", asked or "", f"{times_ours:.2f}",
                     f"{ns / peers.ns[best('raw')]:.2f}", asked_time, f"{1 / times_ours:.1f}", f"{deg:.2f}",
                     asked_error, f"{deg / ours_deg:.2f}"])
    for group, what in (("both", "ours, filter and normals"), ("raw", "ours, normals, raw"),
                        ("filtered", "ours, normals, filtered")):
        name = best(group)
        rows.append([what, f"{peers.ns[name] / 1e6:.1f}", *[""] * 5, f"{peers.counters[name]['rms_deg']:.2f}", "", ""])
    table("Normals of others, 640x480 points, 1.5 mm noise, one thread", ["", "ms", "asked x ours >=", "both",
          "normals only", "asked ours / it <=", "both", "rms deg", "asked x ours >=", "both"], rows)
    rows = [[name.split("/", 1)[1], f"{ns / 1e6:.1f}", f"{peers.counters[name]['rms_mm']:.2f}"]
            for name, ns in peers.ns.items() if name.startswith("filter/")]
    rows.append(["ours, filter, as the difference of both and normals",
                 f"{(peers.ns[both] - peers.ns[best('raw')]) / 1e6:.1f}", ""])
    table("Filters of others", ["", "ms", "rms mm"], rows)


def trade_rows(trade):
    """For each method, in the order of the benchmark: least ms of all noises, and counters by noise in mm."""
    rows = {}
    for name, ns in trade.ns.items():
        _, method, noise = name.split("/")
        ms, by_noise = rows.get(method, (float("inf"), {}))
        rows[method] = (min(ms, ns / 1e6), by_noise | {noise: trade.counters[name]})
    return rows


def print_trade(trade):
    for noise in ("0.5", "1.0", "2.0"):
        rows = [[method, f"{ms:.2f}", *[f"{by_noise[noise]['deg_' + kind]:.2f}" for kind in TRADE_KINDS],
                 f"{by_noise[noise]['fraction_all']:.3f}", f"{by_noise[noise]['fraction_limb']:.3f}"]
                for method, (ms, by_noise) in trade_rows(trade).items() if noise in by_noise]
        table(f"Normals, 640x480 points, {noise} mm noise, one thread: rms angle to the truth, deg; pixels with a normal",
              ["", "ms", *TRADE_KINDS, "fraction", "of limbs"], rows)


def print_bags(times):
    rows = [[name.split("/", 1)[1], ASKED_BAG_FRAMES_PER_S, f"{1e9 / ns:.0f}", f"{1e9 / ns / ASKED_BAG_FRAMES_PER_S:.1f}"]
            for name, ns in times.ns.items()]
    table("PointCloud2 of 640x480 points from a bag, frames per second of CPU time", ["", "asked >=", "measured", "ratio"],
          rows)


def print_meshes(times):
    rows = []
    for name, ns in times.ns.items():
        what, _, mesh = name.partition("/")
        if what != "mesh_distance":
            continue
        plain, discs, build_ns = (times.ns[f"mesh_distance_{of}/{mesh}"] for of in ("plain", "by_discs", "build"))
        rows.append([mesh, ASKED_MESH_DISTANCE_US, f"{ns / 1e3:.2f}", f"{ns / 1e3 / ASKED_MESH_DISTANCE_US:.2f}",
                     f"{discs / ns:.1f}", f"{plain / ns:.0f}", f"{build_ns / 1e6:.0f}"])
    table("Signed distance to a mesh within 10 mm of its surface, us; discs and plain loop: times as long",
          ["mesh, triangles", "asked <=", "measured", "ratio", "discs", "plain", "construction, ms"], rows)
    table("Depth image of 70 056 triangles, 640 x 480 pixels, one thread, ms", ["", "asked <=", "measured", "ratio"],
          [[name.split("/", 1)[1], ASKED_RASTER_MS, f"{ns / 1e6:.2f}", f"{ns / 1e6 / ASKED_RASTER_MS:.2f}"]
           for name, ns in times.ns.items() if name.startswith("raster/")])
