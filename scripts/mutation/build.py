"""Compiles the mutated sources; what a compiler refuses is left out and replaced by the next of the sample."""
import hashlib
import os
import re
import subprocess

from mutation import sources
from mutation.mutation import MutationError

FOLDERS = ("core", "scenarios", "analysis", "runners", "data", "tests", "scripts")
FILES = ("CMakeLists.txt", "LICENSE", "README.md")
OPTIONS = ("-GNinja", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG", "-DCMAKE_UNITY_BUILD=ON",
           "-DCMAKE_UNITY_BUILD_BATCH_SIZE=10", "-DREMOTE_TOUCH_BENCHMARKS=OFF",
           "-DCMAKE_CXX_FLAGS=-w -D_GLIBCXX_ASSERTIONS")  # what reads behind the end of a container is found
NOT_CONSTEXPR = re.compile(r"call to non-.constexpr. function '[^']*?(\w+)\(")
AT = re.compile(r"^(?:In file included from |\s+from )?(/[^:\s]+):(\d+)[:,]", re.MULTILINE)


def digest_of(root, programs):
    """What a matrix belongs to: all sources and tests that git knows or would, but pages and those of scripts/mutate, and
    which programs run."""
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", *FOLDERS], cwd=root,
                            check=True, capture_output=True, text=True).stdout
    digest = hashlib.sha256(" ".join(sorted(programs)).encode())
    for name in sorted(filter(None, listed.split("\0"))):
        if "mutat" not in name and not name.endswith(".md") and (root / name).is_file():
            digest.update(name.encode() + b"\0" + (root / name).read_bytes())
    return digest.hexdigest()[:12]


def refused(log, tree, mutations):
    """Numbers of the mutations on lines that the compiler's errors name; the first line of each error that has one."""
    lines = {}
    for number, mutation in mutations.items():
        for line in range(mutation.line, mutation.line + mutation.original.count("\n") + 1):
            lines.setdefault((str(tree / mutation.file), line + 1), set()).add(number)
    found = set()
    blocks = re.split(r"(?=^/[^\n]*?: (?:fatal )?error: )", log, flags=re.MULTILINE)
    for before, block in zip([""] + blocks, blocks):
        if not re.match(r"/[^\n]*?: (?:fatal )?error: ", block):
            continue
        for text in (block, before[-3000:]):  # "required from here" comes before the error of a template
            hits = [lines[(path, int(line))] for path, line in AT.findall(text) if (path, int(line)) in lines]
            if hits:
                found |= hits[0]
                break
        # A mutated function is not constexpr, and one that is calls it.
        found |= {number for name in NOT_CONSTEXPR.findall(block) for number, mutation in mutations.items()
                  if mutation.function == name and mutation.constexpr}
    return found


def configure(tree, build):
    result = subprocess.run(["cmake", "-S", tree, "-B", build, *OPTIONS], capture_output=True, text=True)
    if result.returncode:
        raise MutationError(result.stdout + result.stderr)


def compile_them(build, targets):
    """The compiler's whole output, or "" when the targets (all, if there are none) are built."""
    result = subprocess.run(["ninja", "-C", build, "-k", "0", *targets], capture_output=True, text=True,
                            env=os.environ | {"LC_ALL": "C", "CCACHE_BASEDIR": str(build)})
    return result.stdout + result.stderr if result.returncode else ""


def build_mutants(root, work, order, mutations, count, targets, say):
    """Builds the first `count` of order (keys of {key: mutation}) that compile, into these targets or all. Returns
    ({number at run time: key}, number of refused ones)."""
    tree, build = work / "tree", work / "build"
    numbers, refused_keys, wanted = {}, set(), count + count // 20
    while True:
        chosen = [key for key in order if key not in refused_keys][:wanted]
        # Numbers stay what they were, so that files without a refused mutation need not be compiled again.
        for key in chosen:
            numbers.setdefault(key, len(numbers))
        active = {numbers[key]: mutations[key] for key in chosen}
        sources.write_tree(root, tree, FOLDERS, FILES, active)
        configure(tree, build)
        log = compile_them(build, targets)
        if not log:
            return {numbers[key]: key for key in chosen[:count]}, len(refused_keys)
        (work / "build.log").write_text(log)
        bad = refused(log, tree, active)
        if not bad:
            raise MutationError(f"no mutation explains an error in {work / 'build.log'}")
        refused_keys |= {key for key in chosen if numbers[key] in bad}
        say(f"{len(bad)} do not compile, {len(refused_keys)} so far")
