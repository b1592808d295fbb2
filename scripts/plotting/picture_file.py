"""Writes a picture as PNG, SVG or PDF, with where it comes from in the metadata of the file. Equal results are equal
files: no file has a date."""
import io

import PIL.Image
import PIL.PngImagePlugin

from .plot_error import PlotError
from .typeset import CONTROL

MADE_BY = "remote-touch, scripts/plot"
FORMATS = ("png", "svg", "pdf")
PIXELS_DPI = (600, 300, 200)  # of what vector formats have as pixels: the first that gives a file of LARGEST_BYTES or less
LARGEST_BYTES = 1_000_000


def origin(figure):
    """What made the numbers, in one line."""
    a = figure.attributes
    dirty = " with local changes" if a.get("git_dirty", "").lower() in ("1", "true", "yes", "dirty") else ""
    return f"version {a.get('version', '?')}, commit {a.get('git_commit', '?')}{dirty}, digest {a.get('digest', '?')}"


def metadata(figure, kind):
    """By the keys that the format has for it."""
    said = {"title": figure.heading, "made_by": MADE_BY, "origin": origin(figure),
            "command": figure.attributes.get("command", "")}
    said = {key: CONTROL.sub("?", words) for key, words in said.items()}
    if kind == "png":
        return {"Title": said["title"], "Software": said["made_by"], "Source": said["origin"], "Comment": said["command"]}
    if kind == "svg":
        return {"Title": said["title"], "Creator": said["made_by"], "Source": said["origin"],
                "Description": said["command"], "Date": None}
    return {"Title": said["title"], "Creator": said["made_by"], "Keywords": said["origin"], "Subject": said["command"],
            "CreationDate": None}


def save_png(canvas, file, said):
    """Drawn once, where Figure.savefig() draws twice."""
    info = PIL.PngImagePlugin.PngInfo()
    for key, words in said.items():
        info.add_itxt(key, words)
    surface = canvas.canvas
    surface.draw()
    pixels = PIL.Image.frombuffer("RGBA", surface.get_width_height(), surface.buffer_rgba(), "raw", "RGBA", 0, 1)
    pixels.convert("RGB").save(file, "PNG", compress_level=5, dpi=(canvas.dpi, canvas.dpi), pnginfo=info)


def save_vectors(canvas, memory, kind, said):
    for dpi in PIXELS_DPI:
        memory.seek(0)
        memory.truncate()
        canvas.savefig(memory, format=kind, metadata=said, dpi=dpi)
        if memory.tell() <= LARGEST_BYTES:
            break


def require_own(file):
    """A picture that something else has made is kept."""
    if file.is_file() and file.stat().st_size and MADE_BY.encode() not in file.read_bytes():
        raise PlotError(f"{file}: is not a picture of scripts/plot: expected another folder, or that file removed")


def save(canvas, file, figure):
    """A reader of the file sees the old picture or the new one."""
    require_own(file)
    kind, memory = file.suffix.removeprefix("."), io.BytesIO()
    if kind == "png":
        save_png(canvas, memory, metadata(figure, kind))
    else:
        save_vectors(canvas, memory, kind, metadata(figure, kind))
    partial = file.with_name(f"{file.name}.partial")
    partial.write_bytes(memory.getvalue())
    partial.replace(file)
