"""The machine on which benchmarks run, as it describes itself."""
import os
import pathlib
import re
import subprocess

from benchmarks.measuring import BUILD, ROOT

KINDS_OF_CACHES = {"Data": "d", "Instruction": "i"}
INSTRUCTIONS = re.compile(r"(s?sse|avx|fma|f16c|bmi)\w*")
# The names of AMD's designs by family and range of models (Linux, arch/x86/kernel/cpu/amd.c).
DESIGNS = {23: [(0x00, 0x2f, "Zen 1"), (0x30, 0x4f, "Zen 2"), (0x60, 0x7f, "Zen 2"), (0x90, 0x91, "Zen 2"),
                (0xa0, 0xaf, "Zen 2")],
           25: [(0x00, 0x0f, "Zen 3"), (0x20, 0x5f, "Zen 3"), (0x10, 0x1f, "Zen 4"), (0x60, 0xaf, "Zen 4")],
           26: [(0x00, 0x2f, "Zen 5"), (0x40, 0x4f, "Zen 5"), (0x60, 0x7f, "Zen 5")]}


def fields_of(cpuinfo):
    """{field: value} of the first processor in the text of /proc/cpuinfo."""
    first = cpuinfo.split("\n\n")[0]
    return {name.strip(): value.strip() for name, _, value in (line.partition(":") for line in first.splitlines())}


def design_of(vendor, family, model):
    """The name of the design, or "" if it is not known."""
    if vendor != "AuthenticAMD":
        return ""
    return next((name for first, last, name in DESIGNS.get(family, []) if first <= model <= last), "")


def processor_of(cpuinfo):
    """Title, and the processor as /proc/cpuinfo states it."""
    fields = fields_of(cpuinfo)
    family, model = int(fields["cpu family"]), int(fields["model"])
    processor = re.sub(r"\((R|TM)\)", "", fields["model name"]).strip()
    design = design_of(fields["vendor_id"], family, model)
    return {"title": f"{processor} ({design or f'family {family}, model {model}'})",
            "processor": f"{fields['model name']}, {fields['vendor_id']}, family {family}, model {model}, "
                         f"stepping {fields['stepping']}",
            "instruction_sets": " ".join(sorted(flag for flag in fields["flags"].split() if INSTRUCTIONS.fullmatch(flag)))}


def caches():
    texts = []
    for folder in sorted(pathlib.Path("/sys/devices/system/cpu/cpu0/cache").glob("index*")):
        level, kind, size = ((folder / name).read_text().strip() for name in ("level", "type", "size"))
        texts.append(f"L{level}{KINDS_OF_CACHES.get(kind, '')} {size}")
    return ", ".join(texts) or "not visible"


def describe_machine(name=""):
    """name: added to the title, if it is not that of the processor alone."""
    described = processor_of(pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8"))
    described["title"] += f", {name}" if name else ""
    return described | {"cores": os.cpu_count(), "caches": caches()}


def compiler():
    cache = (BUILD / "CMakeCache.txt").read_text(encoding="utf-8")
    found = re.search(r"^CMAKE_CXX_COMPILER:\w+=(.*)$", cache, re.MULTILINE)
    said = subprocess.run([found[1] if found else "c++", "--version"], capture_output=True, text=True, check=True).stdout
    return said.splitlines()[0]


def commit():
    """The commit that is measured; stored numbers and pages do not change what is measured."""
    def git(*words):
        return subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()
    changed = git("status", "--porcelain", "--untracked-files=no", "--", ".", ":(exclude)data/benchmarks",
                  ":(exclude)scripts", ":(exclude,glob)**/*.md")
    return git("rev-parse", "--short=12", "HEAD") + (" with changes" if changed else "")
