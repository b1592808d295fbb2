"""One program with all planted bugs, made of patched copies of the sources and the commands of a build."""
import concurrent.futures
import pathlib
import re
import shlex
import shutil

from calls import JOBS, Failure, output_of

CHOICE = r"""#pragma once
#include <cstdlib>
#include <string_view>

namespace planted_bugs {
inline bool is_chosen(std::string_view name) {
  const char* chosen = std::getenv("REMOTE_TOUCH_PLANTED_BUG");
  return chosen != nullptr && name == chosen;
}
}  // namespace planted_bugs
#define PLANTED(name) ([] { static const bool chosen = planted_bugs::is_chosen(name); return chosen; }())
"""

def patched_copies(patches, root, copies):
    """Copies into the folder copies what the patches change, and patches it. Returns the files, as paths from root."""
    files = sorted({file for patch in patches for file in re.findall(r"^\+\+\+ b/(\S+)", patch.read_text(), re.MULTILINE)})
    for file in files:
        (copies / file).parent.mkdir(parents=True, exist_ok=True)
        if not (root / file).is_file():
            raise Failure(f"there is no {file} to patch")
        shutil.copyfile(root / file, copies / file)
    for patch in patches:
        try:
            output_of(["patch", "--strip=1", "--fuzz=0", "--batch", "--forward", "--input", patch], copies)
        except Failure as failure:
            raise Failure(f"{patch.name} does not apply, the source has moved on: {' '.join(str(failure).split())}")
    return files


class Build:
    """The commands that BUILD_FOLDER makes the program with."""

    def __init__(self, folder, root):
        self.folder, self.root = folder, root
        lines = output_of(["ninja", "-t", "commands", "remote-touch"], folder).splitlines()
        self.link = lines[-1]
        self.commands = lines[:-1]

    def compile(self, copies, scratch):
        """All objects of sources, made from their patched copies: {object in the build: object in scratch}."""
        objects, missing, commands = {}, set(copies), []
        for line in self.commands:
            words = shlex.split(line)
            if len(words) < 3 or words[-2] != "-c":
                continue
            source = pathlib.Path(words[-1])
            found = {source} & copies.keys() or self.included_by(source) & copies.keys()
            if not found:
                continue
            missing -= found
            for flag, length in (("-MD", 1), ("-MT", 2), ("-MF", 2)):
                if flag in words:
                    del words[words.index(flag):words.index(flag) + length]
            place = words.index("-o") + 1
            made = scratch / words[place].replace("/", "_")
            words[-1] = str(copies[source] if source in copies else self.unity_copy(source, copies, scratch, made.name))
            objects[words[place]], words[place] = made, str(made)
            commands.append(words)
        with concurrent.futures.ThreadPoolExecutor(JOBS) as pool:
            list(pool.map(lambda words: output_of(words, self.folder), commands))
        if missing:
            raise Failure(f"{', '.join(map(str, sorted(missing)))}: not compiled for remote-touch")
        return objects

    def included_by(self, unity):
        """The sources that CMake compiles together in one file."""
        if not unity.name.startswith("unity_"):
            return set()
        return {pathlib.Path(each) for each in re.findall(r'^#include "(.*)"', (self.folder / unity).read_text(), re.M)}

    def unity_copy(self, unity, copies, scratch, name):
        text = (self.folder / unity).read_text()
        for source, copy in copies.items():
            text = text.replace(f'#include "{source}"', f'#include "{copy}"')
        made = scratch / f"{name}.cxx"
        made.write_text(text)
        return made

    def with_patches(self, patches, scratch):
        """The program with all patches. A member of an archive is not used where an object has all of it."""
        shutil.rmtree(scratch, ignore_errors=True)
        copies = scratch / "patched"
        files = patched_copies(patches, self.root, copies)
        header = scratch / "planted_bugs.h"
        header.write_text(CHOICE)
        for file in files:
            (copies / file).write_text(f'#include "{header}"\n' + (copies / file).read_text())
        objects = self.compile({self.root / file: copies / file for file in files}, scratch)
        link = self.link.replace(" -o remote-touch ", f" -o {shlex.quote(str(scratch / 'remote-touch'))} ")
        for built, made in objects.items():
            if f" {built} " in link:
                link = link.replace(f" {built} ", f" {made} ")
            else:
                link = link.replace(" -o ", f" {made} -o ", 1)
        output_of(["sh", "-c", link], self.folder)
        return scratch / "remote-touch"
