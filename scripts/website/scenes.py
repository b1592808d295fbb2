"""The pictures of README.md that show runs: a loop, and three that stand. All are simulated."""
import hashlib
import json
import pathlib
import subprocess
import tempfile

import PIL.Image

from website import browser

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "build/release/remote-touch"
PAGE = ROOT / "runners/presentation/page"
# The drawing is what decides how a scene and its plot look.
DRAWING = [PAGE / "style.css", ROOT / "scripts/plotting/colours.json", pathlib.Path(__file__), pathlib.Path(__file__).with_name("shots.mjs"),
           *(PAGE / f"src/{name}.ts" for name in ("cloud", "depth_cue", "hand", "plots", "points_buffer", "run_plots", "scene",
                                                  "true_meshes", "truth", "viewpoint"))]
MS_PER_PICTURE = 67
SCENES = {
    "heart": {"experiment": "fig5.8", "ticks": range(8000, 11000, 67), "plot": True},
    "handshake": {"experiment": "handshake", "ticks": [1167]},
    "fixtures": {"experiment": "fig7.5", "ticks": [2667], "nearer": 9},
    "tool": {"experiment": "fig6.3", "ticks": [2667], "nearer": 14},
}
EXIF_DESCRIPTION = 0x010E
PICTURE_ONLY = """body { display: block; height: auto } header, footer, aside, .bar { display: none }
.picture { width: 100vw; height: 100vh }"""
PLOT_ABOVE = """aside { display: block; position: absolute; left: 12px; top: 12px; width: 500px; border: 0; padding: 6px; background: #000a; overflow: hidden }
aside > :not(section:has(> figure)), aside section > :not(figure), figure:not(:first-of-type) { display: none !important }"""


def sources(name):
    experiment = SCENES[name]["experiment"]
    return [*DRAWING, ROOT / f"data/experiments/{experiment}.json", ROOT / f"data/baselines/{experiment}.h5"]


def page_of(experiment, folder, *options):
    """Makes the page of a run."""
    trace, page = folder / f"{experiment}.h5", folder / f"{experiment}.html"
    subprocess.run([PROGRAM, "-q", "--force", "run", experiment, "-o", trace], check=True, stdout=subprocess.DEVNULL)
    subprocess.run([PROGRAM, "-q", "--force", "view", trace, "-o", page, *options], check=True, stdout=subprocess.DEVNULL)
    return page


def shoot(jobs):
    """Takes pictures of pages as shots.mjs describes."""
    with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
        json.dump(jobs, file, default=str)
        file.flush()
        browser.take_pictures("shots.mjs", browser.chromium(), file.name)


def store(name, file, digest):
    """Draws a scene and stores it as WebP, animated if it has several ticks."""
    scene = SCENES[name]
    with tempfile.TemporaryDirectory() as work:
        folder = pathlib.Path(work)
        pictures = [(tick, folder / f"{tick}.png") for tick in scene["ticks"]]
        size = {"width": 700, "height": 480} if scene.get("plot") else {"width": 480, "height": 360}
        shoot([{"page": page_of(scene["experiment"], folder), "size": size, "shown": "body",
                "style": PICTURE_ONLY + (PLOT_ABOVE if scene.get("plot") else ""), "nearer": scene.get("nearer", 0),
                "pictures": pictures}])
        images = [PIL.Image.open(one).convert("RGB") for _, one in pictures]
    exif = PIL.Image.Exif()
    exif[EXIF_DESCRIPTION] = digest
    images[0].save(file, save_all=True, append_images=images[1:], duration=MS_PER_PICTURE, loop=0, quality=60, method=6, exif=exif)


def stored_digest(file):
    with PIL.Image.open(file) as image:
        return image.getexif().get(EXIF_DESCRIPTION)
