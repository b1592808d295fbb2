"""A mutation: one small mistake at one place of the sources, and the list of all that can be made in some files."""
import dataclasses
import hashlib


class MutationError(Exception):
    """The sources do not compile as they are."""


@dataclasses.dataclass(frozen=True)
class Mutation:
    """Text of `file` (path from the root) from byte `start` to `end` becomes `mutated`."""
    file: str
    start: int
    end: int
    line: int
    rule: str  # of RULES in rules.py
    original: str
    mutated: str
    form: str = "value"  # how the choice at run time is written: see sources.py
    function: str = ""
    constexpr: tuple = ()  # (where the `constexpr ` of the declaration around it begins, what it becomes), if it has one

    def key(self):
        """The same for the same mistake after changes elsewhere in the file; equal places are told apart by `number`."""
        return hashlib.sha256("\0".join([self.file, self.function, self.rule, self.original, self.mutated])
                              .encode()).hexdigest()[:12]


def numbered(mutations):
    """{key: mutation}: where one function makes the same mistake possible twice, the keys end in -2, -3 and so on."""
    result = {}
    for mutation in sorted(mutations, key=lambda m: (m.file, m.start, m.end, m.rule, m.mutated)):
        key, count = mutation.key(), 2
        while key in result:
            key = f"{mutation.key()}-{count}"
            count += 1
        result[key] = mutation
    return result


def sample(mutations, seed, count):
    """The `count` keys that come first when the hashes of seed and key are sorted: a change of one file leaves the rest of
    the sample as it was."""
    def place(key):
        return hashlib.sha256(f"{seed}:{key}".encode()).hexdigest()
    return sorted(mutations, key=place)[:count]
