"""What the trials of a sample found, as text."""
import math


def wilson(successes, trials, z=1.959964):
    """95 % interval of a fraction (Wilson 1927)."""
    if trials == 0:
        return 0.0, 1.0
    p = successes / trials
    centre = p + z * z / (2 * trials)
    half = z * math.sqrt(p * (1 - p) / trials + z * z / (4 * trials * trials))
    return (centre - half) / (1 + z * z / trials), (centre + half) / (1 + z * z / trials)


def mcnemar(only_one, only_other):
    """p of the exact test (McNemar 1947) that of the pairs that differ as many differ in either direction."""
    pairs = only_one + only_other
    tail = sum(math.comb(pairs, k) for k in range(min(only_one, only_other) + 1)) / 2**pairs
    return min(1.0, 2 * tail)


def fraction(successes, trials):
    low, high = wilson(successes, trials)
    return f"{successes} of {trials} = {successes / max(trials, 1):.3f} [{low:.3f}, {high:.3f}]"


def summary(stages, equivalent):
    """stages: what found each mutation that was tried; equivalent: how many were not tried. Lines of text."""
    without_bits = sum(stage in ("unit", "program") for stage in stages)
    by_all = without_bits + stages.count("bits")
    yield f"mutations tried: {len(stages)}; not tried, as they are listed with a reason: {equivalent}"
    for stage in ("unit", "program", "bits", "survived", "unreached"):
        yield f"  {stage:<10} {stages.count(stage)}"
    yield f"found without stored results: {fraction(without_bits, len(stages))}"
    yield f"found by all tests:           {fraction(by_all, len(stages))}"


def line(key, mutation):
    def short(text):
        text = " ".join(text.split())
        return text if len(text) <= 70 else text[:67] + "..."
    return (f"{key}  {mutation.file}:{mutation.line} {mutation.function} {mutation.rule}: "
            f"{short(mutation.original)}  ->  {short(mutation.mutated) or '(left out)'}")
