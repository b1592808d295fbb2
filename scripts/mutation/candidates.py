"""All mutations that the rules find in the sources of some folders."""
import concurrent.futures
import pathlib
import re

import clang.cindex as clang
from clang.cindex import CursorKind as Kind

from mutation import rules
from mutation.mutation import Mutation, MutationError

# What the tables and the compiler fix: a value there cannot depend on a choice at run time.
FIXED = {Kind.STATIC_ASSERT, Kind.CASE_STMT, Kind.ENUM_DECL, Kind.TEMPLATE_TEMPLATE_PARAMETER,
         Kind.TEMPLATE_NON_TYPE_PARAMETER, Kind.USING_DECLARATION, Kind.TYPE_ALIAS_DECL, Kind.TYPEDEF_DECL}
FUNCTIONS = {Kind.FUNCTION_DECL, Kind.CXX_METHOD, Kind.CONSTRUCTOR, Kind.DESTRUCTOR, Kind.FUNCTION_TEMPLATE,
             Kind.CONVERSION_FUNCTION}


HDF5 = "-I/usr/include/hdf5/serial"  # where Debian has it
# The header that the build writes, with other texts.
BUILD_INFO = "".join(f'#define REMOTE_TOUCH_{name} ""\n'
                     for name in ("VERSION", "GIT_COMMIT", "GIT_DIRTY", "SOURCES", "COMPILER", "FLAGS"))


def flags(root):
    return ["-std=c++20", "-xc++", f"-I{root}", "-isystem/usr/include/eigen3", "-DEIGEN_DONT_VECTORIZE", "-march=x86-64-v4",
            "-DREMOTE_TOUCH_LEVEL=x86_64_v4", HDF5]


class Walk:
    """Goes through the tree of one folder's sources; keeps what lies in `prefixes` and comes from a file of the project."""

    def __init__(self, root, prefixes):
        self.root, self.prefixes = pathlib.Path(root), prefixes
        self.texts, self.found = {}, {}

    def path_of(self, node):
        """The file of the node from the root, when it may be mutated."""
        start, end = node.extent.start, node.extent.end
        if not start.file or not end.file or start.file.name != end.file.name:
            return None
        path = start.file.name
        if not path.startswith(f"{self.root}/"):
            return None
        path = path[len(str(self.root)) + 1:]
        return path if path.startswith(self.prefixes) else None

    def text(self, path):
        if path not in self.texts:
            self.texts[path] = rules.Text((self.root / path).read_bytes())
        return self.texts[path]

    def enter(self, node, function="", constexpr=()):
        try:
            if node.kind in FIXED:
                return
        except ValueError:  # a kind that the Python interface does not know
            return
        path = self.path_of(node)
        if node.kind in FUNCTIONS:
            function = node.spelling
        if path and node.kind in FUNCTIONS | {Kind.VAR_DECL}:
            constexpr = self.constexpr_of(node, path) or constexpr
        if path:
            self.keep(node, path, function, constexpr)
        for child in node.get_children():
            self.enter(child, function, constexpr)

    def constexpr_of(self, node, path):
        """A constexpr declaration that depends on a choice at run time is no longer constexpr."""
        declared = re.split(r"[={(]", self.text(path).node(node))[0]
        at = declared.find("constexpr ")
        if at < 0:
            return ()
        becomes = "const "
        if node.kind in FUNCTIONS:
            becomes = "inline "
        elif node.semantic_parent and node.semantic_parent.kind in (Kind.CLASS_DECL, Kind.STRUCT_DECL):
            becomes = "inline const "
        return (node.extent.start.offset + len(declared[:at].encode()), becomes)

    def keep(self, node, path, function, constexpr):
        text = self.text(path)
        for rule in rules.RULES:
            try:
                for name, mutated, form in rule(node, text):
                    form, at = form if isinstance(form, tuple) else (form, node)
                    self.add(at, path, text, name, mutated, form, function, constexpr)
            except (ValueError, UnicodeDecodeError):  # a node whose text comes from a macro
                continue

    def add(self, node, path, text, rule, mutated, form, function, constexpr):
        start, end = node.extent.start.offset, node.extent.end.offset
        original = text.of(start, end)
        if not original or "//" in original or "#" in original or end <= start:
            return
        if form == "statement":
            rest = text.data[end:end + 1]
            if rest != b";":
                return
            end += 1
            original += ";"
        mutation = Mutation(path, start, end, node.extent.start.line, rule, original, " ".join(mutated.split()), form,
                            function, constexpr)
        self.found[(path, start, end, rule, mutated)] = mutation


def parse(root, name, sources):
    """One translation unit of all sources, as the build joins them; None where they do not compile together."""
    text = "".join(f'#include "{source}"\n' for source in sources)
    unit = clang.Index.create().parse(str(root / name), args=flags(root), unsaved_files=[
        (str(root / name), text), (str(root / "build_info.h"), BUILD_INFO)])
    errors = [d for d in unit.diagnostics if d.severity >= clang.Diagnostic.Error]
    if errors and len(sources) == 1:
        raise MutationError(f"{sources[0]}: {errors[0].spelling} ({errors[0].location.line})")
    return None if errors else unit


def in_folder(root, folder, prefixes):
    """All mutations in the sources of one folder and in what they include."""
    sources = sorted((root / folder).glob("*.cpp"))
    joined = parse(root, f"{folder}/joined.cpp", sources)
    units = [joined] if joined else [parse(root, f"{folder}/joined.cpp", [source]) for source in sources]
    walk = Walk(root, prefixes)
    for node in [node for unit in units for node in unit.cursor.get_children()]:
        if node.location.file and node.location.file.name.startswith(str(root)):
            walk.enter(node)
    return list(walk.found.values())


def in_paths(root, paths):
    """All mutations in the files below `paths` (folders or files without their ending), once each."""
    root = pathlib.Path(root).resolve()
    folders = sorted({str(source.parent.relative_to(root)) for path in paths for source in
                      [*(root / path).rglob("*.cpp"), *root.glob(f"{path}*.cpp")]})
    found = {}
    with concurrent.futures.ProcessPoolExecutor(2) as pool:
        for mutations in pool.map(in_folder, [root] * len(folders), folders, [tuple(paths)] * len(folders)):
            for mutation in mutations:
                found[(mutation.file, mutation.start, mutation.end, mutation.rule, mutation.mutated)] = mutation
    return list(found.values())
