"""Writes the sources with all chosen mutations in them; which one acts is chosen when the program starts.

REMOTE_TOUCH_MUTATION=n makes mutation n act, none when it is not set. A process notes in the file of
REMOTE_TOUCH_MUTATION_REACHED, one byte for each mutation, which places it came by.
"""
import filecmp
import pathlib
import shutil

HEADER = "mutation.h"
MAX_MUTATIONS = 65536
CHOICE = r"""#pragma once
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>

// Which mutation acts in this process, and which places it came by.
namespace mutation {
constexpr int kMax = %d;
inline unsigned char unseen[kMax] = {};
inline unsigned char* reached = unseen;
inline int acting = -1;

// Before any other variable is initialised: constants may be mutated, too.
[[gnu::constructor(101)]] inline void begin() {
  if (const char* number = std::getenv("REMOTE_TOUCH_MUTATION")) acting = std::atoi(number);
  const char* path = std::getenv("REMOTE_TOUCH_MUTATION_REACHED");
  if (path == nullptr || reached != unseen) return;
  const int file = ::open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0 || ::ftruncate(file, kMax) != 0) std::abort();
  void* mapped = ::mmap(nullptr, kMax, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  if (mapped == MAP_FAILED) std::abort();
  reached = static_cast<unsigned char*>(mapped);
  ::close(file);
}

inline bool acts(int number) {
  reached[number] = 1;
  return number == acting;
}
}  // namespace mutation
""" % MAX_MUTATIONS

WRITTEN = {
    "value": "(::mutation::acts({number}) ? ({mutated}) : ({original}))",
    "evaluated": "(::mutation::acts({number}) ? {mutated} : ({original}).eval())",
    "statement": "{{ if (!::mutation::acts({number})) {{ {original} }} }}",
    "break": "if (!::mutation::acts({number})) {original}",
}


def edits(mutations):
    """[(start, end, format of the new text)] of {number: mutation}, the outer before the inner."""
    found = []
    for number, mutation in sorted(mutations.items()):
        form = "break" if mutation.original in ("break;", "continue;") else mutation.form
        text = WRITTEN[form].replace("{number}", str(number)).replace("{mutated}", doubled(mutation.mutated))
        found.append((mutation.start, mutation.end, text))
    for start, becomes in {m.constexpr for m in mutations.values() if m.constexpr}:
        found.append((start, start + len("constexpr "), becomes))
    return sorted(found, key=lambda edit: (edit[0], -edit[1]))


def doubled(text):
    return text.replace("{", "{{").replace("}", "}}")


def render(data, order, first, start, end):
    """(text of start to end with all edits in it, index of the first edit behind it)"""
    parts, at = [], start
    while first < len(order) and order[first][0] < end:
        begin, stop, form = order[first]
        inner, first = render(data, order, first + 1, begin, stop)
        parts += [data[at:begin], form.format(original=inner.decode()).encode()]
        at = stop
    return b"".join([*parts, data[at:end]]), first


def write_file(source, target, mutations):
    """target is source with its mutations, each line one line lower."""
    data = source.read_bytes()
    text, _ = render(data, edits(mutations), 0, 0, len(data))
    write_changed(target, f'#include "{HEADER}"\n'.encode() + text)


def write_changed(target, text):
    if not target.exists() or target.read_bytes() != text:
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(text)


def write_tree(root, tree, folders, files, mutations):
    """tree is a copy of root's folders and files, with {number: mutation} in it."""
    write_changed(tree / HEADER, CHOICE.encode())
    by_file = {}
    for number, mutation in mutations.items():
        by_file.setdefault(mutation.file, {})[number] = mutation
    wanted = {pathlib.Path(name) for name in files}
    for folder in folders:
        wanted |= {path.relative_to(root) for path in (root / folder).rglob("*") if path.is_file()}
    for path in sorted(wanted):
        source, target = root / path, tree / path
        if str(path) in by_file:
            write_file(source, target, by_file[str(path)])
        elif not target.exists() or not filecmp.cmp(source, target, shallow=False):
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source, target)  # not its time stamp: what was compiled from a mutated copy is out of date
    for path in [path for folder in folders for path in (tree / folder).rglob("*") if path.is_file()]:
        if path.relative_to(tree) not in wanted:
            path.unlink()
