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


def fraction(successes, trials):
    low, high = wilson(successes, trials)
    return f"{successes} of {trials} = {successes / max(trials, 1):.3f} [{low:.3f}, {high:.3f}]"


def summary(results, equivalent):
    """results: {key: {"found": stage, ...}}; equivalent: {key: reason}. Lines of text."""
    counted = {key: result for key, result in results.items() if key not in equivalent}
    without_bits = sum(r["found"] in ("unit", "program") for r in counted.values())
    by_all = sum(r["found"] in ("unit", "program", "bits") for r in counted.values())
    yield f"mutations tried: {len(results)}, of these equivalent with a reason: {len(results) - len(counted)}"
    for stage in ("unit", "program", "bits", "survived", "unreached"):
        yield f"  {stage:<10} {sum(r['found'] == stage for r in counted.values())}"
    yield f"found without stored results: {fraction(without_bits, len(counted))}"
    yield f"found by all tests:           {fraction(by_all, len(counted))}"


def line(key, mutation):
    def short(text):
        text = " ".join(text.split())
        return text if len(text) <= 70 else text[:67] + "..."
    return (f"{key}  {mutation.file}:{mutation.line} {mutation.function} {mutation.rule}: "
            f"{short(mutation.original)}  ->  {short(mutation.mutated) or '(left out)'}")
