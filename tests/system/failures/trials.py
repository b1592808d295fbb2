"""One failure in one command, and whether all is well afterwards."""
import dataclasses
import os
import re
import shutil
import signal
import struct
import subprocess
import tempfile

from commands import EMPTY, KINDS, UNFINISHED, done_runs, is_kept, read, restore, state_of

# What only a library or the language would say.
FOREIGN = re.compile(r"std::|bad_alloc|basic_|json\.exception|HDF5-DIAG|library refused|libgomp|terminate|what\(\)|"
                     r"vector::|malloc")
# The C library says so by itself, before the program's line, where the HDF5 library damaged the heap after it found no
# memory, and so does that of OpenMP, which ends the program. They cannot be told not to.
DAMAGED_HEAP = re.compile(r"\A(?:corrupted|malloc\(\)|free\(\)|realloc\(\)|double free|munmap_chunk\(\)|Fatal glibc error: "
                          r"malloc)[^\n]*\n(?=remote-touch: (?:the HDF5 library failed: out of memory"
                          r"|[^\n]*: damaged \(its reader ended with signal 6, perhaps out of memory\)))"
                          r"|\A\nlibgomp: Out of memory allocating \d+ bytes\n(?=remote-touch: )")
# OpenMP ends the program by itself where it finds no memory for its threads, and its library has no call to prevent it.
ENDED_BY_OPENMP = re.compile(r"\A\nlibgomp: Out of memory allocating \d+ bytes\n\Z")
# It ended the program at once, as did a lack of memory where no exception may leave, such as in the destructor of JSON.
ENDED_AT_ONCE = re.compile(r"the HDF5 library failed|\Aremote-touch: out of memory\n\Z")
# What a program that was killed left in the cache, where others may be writing: one that writes there an hour later
# removes it.
ABANDONED = re.compile(r"cache/[^/]*\.partial-")
# What the message of each failure has to say.
REASON = {"ENOSPC": "No space left on device", "EIO": "Input/output error", "ENOMEM": "memory"}


@dataclasses.dataclass
class Failure:
    kind: str
    call: int
    how: str  # ENOSPC, EIO, ENOMEM, or KILL
    process: int = 0  # 0: any

    def __str__(self):
        return f"{self.kind}:{self.call}:{self.how}" + (f" in process {self.process}" if self.process else "")


@dataclasses.dataclass
class Outcome:
    failed: bool    # the call came, and failed
    harmless: bool  # with the whole result all the same
    problem: str    # empty: none
    damaged_heap: bool = False  # by the HDF5 library, as the C library said
    by_openmp: bool = False  # its library ended the program


def counted(counts):
    """How many calls there were of each kind, and how many of them failed."""
    with open(counts, "rb") as file:
        numbers = struct.unpack(f"{len(KINDS) + 1}Q", file.read(8 * (len(KINDS) + 1)))
    return dict(zip(KINDS, numbers)), numbers[-1]


def new_counts(folder):
    handle, path = tempfile.mkstemp(dir=folder)
    os.write(handle, bytes(4096))
    os.close(handle)
    return path


class Trials:
    """Of one scene, in a folder of its own; for one thread at a time."""

    scratch = os.path.join("tmp", "remote-touch-bless-")

    def __init__(self, scene, trace=None):
        self.scene, self.tools, self.command = scene, scene.tools, scene.command
        self.place = tempfile.mkdtemp(dir=self.tools.folder)
        self.folder = os.path.join(self.place, "made")
        self.counts = new_counts(self.place)
        restore(self.folder, scene.before)
        self.server = self.tools.serve(self.place, self.command.arguments, self.counts, trace)
        self.first = int(self.server.stdout.readline()) + 1  # allocation that it can fail

    def close(self):
        self.server.stdin.close()
        self.server.wait()
        shutil.rmtree(self.place)

    def spawn(self, **failing):
        """From the loader on."""
        with open(self.counts, "r+b") as file:
            file.write(bytes(4096))
        return self.tools.call(self.folder, self.command.arguments, counts=self.counts, **failing)

    def ask(self, wish, process):
        """The same of the server."""
        self.server.stdin.write(f"{wish} {process} {self.place}\n")
        code = os.waitstatus_to_exitcode(int(self.server.stdout.readline()))
        if code == -signal.SIGALRM:
            return None
        out, err = (read(os.path.join(self.place, name)) for name in ("out", "err"))
        return subprocess.CompletedProcess(self.command.arguments, code, out, err)

    def count(self, process=0, sites=None):
        """Calls of each kind when nothing fails."""
        self.spawn(process=process, sites=sites)
        restore(self.folder, self.scene.before)
        return counted(self.counts)[0]

    def attempt(self, failure):
        wish = f"{failure.kind}:{failure.call}:{failure.how}"
        if failure.kind == "allocation" and failure.process < 2 and failure.call < self.first:
            done = self.spawn(wish=wish, process=failure.process)
        else:
            done = self.ask(wish, failure.process)
        failed = counted(self.counts)[1] > 0
        state = state_of(self.folder)
        harmless = done is not None and done.returncode == 0
        problem = self.judge(failure, done, state) if failed else ""
        if state != self.scene.before:
            if not problem:
                problem = self.again(state)
            restore(self.folder, self.scene.before)
        message = "" if done is None else done.stderr.decode(errors="replace")
        return Outcome(failed, harmless, problem, bool(DAMAGED_HEAP.match(message)), bool(ENDED_BY_OPENMP.match(message)))

    def judge(self, failure, done, state):
        if done is None:
            return "does not end"
        message = DAMAGED_HEAP.sub("", done.stderr.decode(errors="replace"))
        if failure.how == "KILL":
            if done.returncode != -9 and failure.process == 0 and not message:
                return f"exit {done.returncode} after a kill"
            return self.lost(state, killed=True)
        if done.returncode == 1 and ENDED_BY_OPENMP.match(message):
            return self.lost(state) or self.litter(failure, state)
        if done.returncode not in (0, 2):
            return f"exit {done.returncode}: {message[:300]!r}"
        if done.returncode == 2:
            if not (message.startswith("remote-touch: ") and message.count("\n") == 1 and message.endswith("\n")):
                return f"not one line: {message[:300]!r}"
            if FOREIGN.search(message):
                return f"a message of a library: {message[:300]!r}"
            if REASON[failure.how] not in message:
                return f"no word of {REASON[failure.how]!r}: {message[:300]!r}"
            return self.lost(state) or self.litter(failure, state, message)
        if message:
            return f"exit 0, but it says {message[:300]!r}"
        return self.incomplete(failure, state)

    def lost(self, state, killed=False):
        """What was complete before is so afterwards."""
        before, after = self.scene.before, self.scene.after
        for name, content in before.items():
            if state.get(name) == content:
                continue
            if name not in state:
                return f"{name} is gone"
            if name != self.command.result and not name.endswith("manifest.json"):
                return f"{name} changed"
            if self.command.in_progress:
                kept, now = done_runs_in(content), done_runs_in(state[name])
                if any(now.get(run) != values for run, values in kept.items()):
                    return f"{name} lost runs"
            elif self.command.same_bytes and state[name] != after[name]:
                return f"{name} is neither the earlier nor the new result"
        return self.half(state, killed)

    def half(self, state, killed):
        """Of files that belong together none is new while the other is old; but a kill may come between two renames."""
        if self.command.name != "bless" or killed and state["stored/manifest.json"] == self.scene.before["stored/manifest.json"]:
            return ""
        news = {name: state[name] == self.scene.after[name] for name in ("stored/lift.h5", "stored/manifest.json")}
        return "" if len(set(news.values())) == 1 else f"one of two is new: {news}"

    def litter(self, failure, state, message=""):
        extra = set(state) - set(self.scene.before) - set(self.scene.after)
        extra = {name for name in extra if not name.endswith(".lock")}  # that nobody holds: the next command takes it
        if UNFINISHED in message or ENDED_AT_ONCE.search(message):  # what was recorded is kept, and named
            extra -= {UNFINISHED}
        if ENDED_AT_ONCE.search(message):  # nothing could be removed; the next command does
            extra = {name for name in extra if not name.startswith(self.scratch) and ".partial-" not in name}
        return "" if failure.kind == "remove" or not extra else f"left {sorted(extra)}"

    def incomplete(self, failure, state):
        extra = set(state) ^ set(self.scene.after)
        if extra and failure.kind != "remove":
            return f"exit 0 with other files: {sorted(extra)}"
        wrong = [name for name, content in self.scene.after.items() if state.get(name) != content]
        if not self.command.same_bytes:
            wrong = [name for name in wrong if name != self.command.result]
            if not wrong:
                return self.unreadable()
        return f"exit 0, but {wrong} is another result" if wrong else ""

    def unreadable(self):
        """A recording holds the times of this machine: that it runs again is what can be asked."""
        done = self.tools.call(self.folder, ["run", self.command.result, "-o", "tmp/again.h5"])
        again = os.path.join(self.folder, "tmp/again.h5")
        if os.path.exists(again):
            os.remove(again)
        good = done is not None and (done.returncode == 0 or EMPTY.search(done.stderr))
        return "" if good else f"{self.command.result} cannot be run"

    def again(self, state):
        """The same command, undisturbed, on what is there now. A recording that is kept comes first."""
        if problem := is_kept(self.tools, self.folder):
            return problem
        done = self.tools.call(self.folder, self.command.arguments)
        if done is None or done.returncode != 0 or done.stderr:
            return f"the same command again: {done and (done.returncode, done.stderr[:300])}"
        now = state_of(self.folder)
        if not self.command.same_bytes:
            now[self.command.result] = self.scene.after[self.command.result]
        different = sorted(name for name in {*now, *self.scene.after} if now.get(name) != self.scene.after.get(name)
                           and not ABANDONED.match(name))
        if different:
            return f"the same command again gives other files: {different}"
        return "" if self.command.same_bytes else self.unreadable()


def done_runs_in(content):
    with tempfile.NamedTemporaryFile(suffix=".h5") as file:
        file.write(content)
        file.flush()
        return done_runs(file.name)
