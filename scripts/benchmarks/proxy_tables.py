"""Tables of the proxy on the terminal: steps, queries, noise, regions, the map of figure 4.13, the tracked sheet, searches of others."""
from benchmarks.aims import *
from benchmarks.printing import show, table, verdict

FIXTURES = {"none": "no radii", "zero": "all 0", "all": "all 0.02 m", "half": "half 0.02 m, half 0",
            "stiff": "all 0.02 m, stiffness"}
FIXTURE_STEPS = {"contact": ["contact"], "free": ["free"], "entrenched": ["entrenched"],
                 "contact, with a new list": ["contact", "gather"]}
MAP_ROWS = {"plain": "written plainly, standard library's noise", "all noise": "ours, but all noise made",
            "sample": "ours", "map": "ours"}


def print_times(times):
    """All benchmarks that exist for each instruction set level, one row each."""
    rows, seen = [], set()
    for name in times.ns:
        stem, _, level = name.rpartition("/")
        per_level = level in LEVELS
        key = stem if per_level else name
        if key in seen:
            continue
        seen.add(key)
        cells = [show(times.ns[name]), "", ""]
        if per_level:
            cells = [show(times.ns.get(f"{key}/{each}")) for each in LEVELS]
        counters = times.counters[name]
        notes = [f"{counters[c]:.4g} {label}" for c, label in
                 (("within_r3", "within r3"), ("listed", "listed"), ("steps", "steps"), ("found", "found"))
                 if c in counters]
        rows.append([key, *cells, ", ".join(notes)])
    table("ns", ["", *LEVELS, ""], rows)


def print_steps(times):
    naive = times.ns.get("step_naive/grid")
    rows = []
    for level, asked in ASKED_STEP_NS.items():
        for cloud in ("grid", "image"):
            tick = times.ns.get(f"tick/{cloud}/{level}")
            steps = times.counters.get(f"tick/{cloud}/{level}", {}).get("steps", 0)
            measured = [
                ("search as the renderer does it", times.ns.get(f"step_with_kept_list/{cloud}/{level}")),
                ("search at every step", times.ns.get(f"step_with_search/{cloud}/{level}")),
                ("whole tick, per step", tick / steps if tick and steps else None)]
            for what, ns in measured:
                if ns is None or naive is None:
                    continue
                of_naive = f"{naive / ns:.0f}" if cloud == "grid" else ""
                asked_of_naive = ASKED_OF_NAIVE if cloud == "grid" else ""
                rows.append([f"{what}, {cloud}, {level}", asked, show(ns), f"{ns / asked:.2f}",
                             asked_of_naive, of_naive])
    table("One proxy step in contact, ns; naive: over all 100x100 points, "
          f"{show(naive)} ns", ["", "asked <=", "measured", "ratio", "asked x naive >=", "measured"], rows)


def print_queries(times):
    rows = []
    for name in ("image_1.03m_slide", "image_1.03m_jump"):
        for level in LEVELS:
            ns = times.ns.get(f"query_window/{name}/{level}")
            if ns is not None:
                rows.append([f"{name}, {level}", REACHABLE_QUERY_NS, show(ns), f"{ns / REACHABLE_QUERY_NS:.2f}"])
    table("Radius query on 640x480 points, 81 found, ns", ["", "reachable", "measured", "ratio"], rows)


def print_normals(times):
    standard = times.counters.get("normals_standard_library", {}).get("s_per_normal")
    rows = []
    for level in LEVELS:
        own = times.counters.get(f"normals/{level}", {}).get("s_per_normal")
        if own and standard:
            rows.append([level, f"{own * 1e9:.2f}", f"{standard / own:.1f}"])
    table("Normals, ns each", ["", "measured", "x std::normal_distribution"], rows)


def ns_per_point(times, name):
    counters = times.counters[name]
    return times.ns[name] / counters.get("listed", counters.get("found"))


def print_fixture_times(times):
    rows = []
    for level in LEVELS:
        for fixture, what in FIXTURES.items():
            of = f"{fixture}/{level}"
            tick = times.ns.get(f"fixture_tick/{of}")
            steps = times.counters.get(f"fixture_tick/{of}", {}).get("steps")
            names = [f"fixture_{kind}/{of}" for kind in ("contact", "free", "free_far", "entrenched", "gather")]
            if not tick or any(name not in times.ns for name in names):
                continue
            rows.append([f"{what}, {level}", f"{times.counters[names[0]]['listed']:.0f}",
                         *[show(times.ns[name]) for name in names],
                         *[f"{ns_per_point(times, name):.2f}" for name in (names[0], names[-1])],
                         f"{tick / 1000:.1f}", f"{steps:.1f}"])
    table("Forbidden regions r_f, 640x480 points 1 mm apart: a proxy step in each state, a new list, a tick; ns",
          ["", "listed", "contact", "free", "free, HIP far", "entrenched", "new list", "contact / point",
           "new list / point", "tick, us", "steps"], rows)
    rows = [[name.partition("_")[2].replace("_", " "), f"{ns / 1e6:.2f}"] for name, ns in times.ns.items()
            if name.startswith(("fixture_assign/", "fixture_make_search/"))]
    table("Preparing a frame of 640x480 points, ms", ["", "measured"], rows)


def print_fixture_criterion(times):
    rows = []
    for level in LEVELS:
        for what, parts in FIXTURE_STEPS.items():
            names = [[f"fixture_{part}/{fixture}/{level}" for part in parts] for fixture in ("none", "all")]
            if any(name not in times.ns for both in names for name in both):
                continue
            per_point = [sum(ns_per_point(times, name) for name in both) for both in names]
            ratio = per_point[1] / per_point[0]
            rows.append([f"{what}, {level}", f"{per_point[0]:.2f}", f"{per_point[1]:.2f}", ASKED_OF_REGIONS,
                         f"{ratio:.2f}", "met" if ratio <= ASKED_OF_REGIONS else "NOT met"])
    table("One proxy step per point visited, ns: all r_f = 0.02 m beside no radii",
          ["", "no radii", "0.02 m", "asked <=", "ratio", ""], rows)


def print_programs(times):
    rows = []
    for name, ns in times.ns.items():
        kind, _, count = name.partition("/")
        if kind != "program_ours":
            continue
        us, asked = ns / 1000, ASKED_PROGRAM_US.get(int(count))
        others = [times.ns.get(f"program_{kind}/{count}") for kind in ("with_rows", "nlopt", "subsets")]
        rows.append([f"{count} rows", asked or "", REACHABLE_PROGRAM_US.get(int(count), ""), f"{us:.2f}",
                     f"{us / asked:.2f}" if asked else "",
                     *[f"{other / 1000:.2f}" if other else "-" for other in others],
                     f"{others[1] / ns:.0f}" if others[1] else "-"])
    table("Quadratic program of 6 variables, random rows, us",
          ["", "asked <=", "reachable", "measured", "ratio", "rows filled in too", "NLopt SLSQP", "all subsets",
           "x NLopt"], rows)


def print_sheet(times):
    rows = []
    for name, sheet in times.counters.items():
        _, method, noise, level = name.split("/")
        proxy = times.counters.get(f"sheet_lift/proxy/{noise}/{level}")
        if method != "tracked-sheet" or not proxy:
            continue
        asked = ASKED_SHEET_FRAME_US.get(noise)
        frame_us, ratio = sheet["frame_ns"] / 1000, sheet["tick_ns"] / proxy["tick_ns"]
        rows.append([f"noise {noise} r_c, {level}", f"{proxy['frame_ns'] / 1000:.1f}", asked or "", f"{frame_us:.0f}",
                     verdict(frame_us, asked),
                     *[f"{each['tick_ns'] / 1000:.2f}" for each in (proxy, sheet)], ASKED_SHEET_TICK,
                     f"{ratio:.2f}", verdict(round(ratio, 2), ASKED_SHEET_TICK),
                     *[" / ".join(f"{each[what]:{form}}" for each in (proxy, sheet))
                       for what, form in (("steps", ".1f"), ("in_contact", ".2f"))]])
    table("Tracked sheet beside the proxy on the same lifts, us: a frame; a tick while the HIP is below the cloud",
          ["", "frame, proxy", "asked <=", "sheet", "", "tick, proxy", "sheet", "asked <=", "ratio", "",
           "steps", "in contact"], rows)


def print_peers(peers):
    rows = []
    for name, theirs in peers.ns.items():
        kind, cloud, peer = name.split("/", 2)
        if kind != "query" or peer.startswith("ours"):
            continue
        asked = ASKED_OF_PEERS.get(peer, "") if cloud.startswith("image") else ""
        ours = [peers.ns.get(f"query/{cloud}/ours/{level}") for level in LEVELS]
        rows.append([f"{cloud}, {peer}", show(theirs), asked, *[f"{theirs / ns:.2f}" if ns else "-" for ns in ours]])
    table("Radius query of others, ns, and how many times ours that is",
          ["", "theirs", "asked x >=", *LEVELS], rows)
    # The instruction set makes no difference to ours here.
    rows = [[name.split("/", 1)[1], show(ns / 1000)] for name, ns in peers.ns.items()
            if name.startswith("prepare/") and ("/ours/" not in name or name.endswith("/x86-64"))]
    table("Preparing a frame, us; the copy of the cloud included", ["", "measured"], rows)


def print_map(times):
    measured = [line for line in times.lines if "time" in line]
    one_thread_s = next(line["map_s"] for line in measured if line["time"] == "map")
    rows = []
    for line in measured:
        seconds, key = line["map_s"], (line["steps"], line["threads"])
        asked = ASKED_MAP_S.get(key) if line["time"] == "map" else None
        rows.append([f"{MAP_ROWS[line['time']]}, {line['lifts']} lifts timed", line["steps"], line["threads"],
                     asked or "", f"{seconds:.2f}", f"{line['map_cpu_s']:.2f}",
                     f"{seconds / asked:.2f}" if asked else "", ASKED_MAP_OF_PLAIN if line["time"] == "plain" else "",
                     f"{seconds / one_thread_s:.1f}" if key == (30, 1) else ""])
    table(f"Fig 4.13: the whole map, s, {measured[0]['isa']}; CPU far below threads x measured: the machine was shared",
          ["", "steps a frame <=", "threads", "asked <=", "measured", "CPU", "ratio", "asked x map >=", "measured"],
          rows)
    rows = [[f"{line['lift']} mm noise", ASKED_LIFT_MS[line["lift"]] or "", f"{1000 * line['lift_cpu_s']:.2f}"]
            for line in times.lines if "lift" in line]
    table("Fig 4.13: a lift with six measures, 30 steps a tick, ms of CPU time", ["", "asked <=", "measured"], rows)


def print_proxy(times):
    for show_part in (print_times, print_steps, print_queries, print_fixture_times, print_fixture_criterion, print_normals,
                      print_programs):
        show_part(times)
