"""Which few of the stored results find all mistakes that any of them finds."""
import concurrent.futures


def found_by(machine, number, tests):
    """The names of the stored results that differ when the mistake acts."""
    reaching = [test for test in tests if test.stage == "bits" and number in test.reached]
    return [test.name for test in reaching
            if not machine.run(test.command, 10 + 5 * test.seconds, mutation=number)]


def found_by_each(machine, numbers, tests, say):
    """{number: names}, for the mistakes that some stored result reaches."""
    found = {}
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        for done, (number, names) in enumerate(
                zip(numbers, pool.map(lambda number: found_by(machine, number, tests), numbers)), 1):
            found[number] = names
            say(f"{done} of {len(numbers)}: {len(names)} stored results differ")
    return found


def greedy(found):
    """[(name, how many mistakes it is the first to find)]; each finds most of what those before it leave."""
    left = {number: set(names) for number, names in found.items() if names}
    chosen = []
    while left:
        counts = {}
        for names in left.values():
            for name in names:
                counts[name] = counts.get(name, 0) + 1
        best = min(counts, key=lambda name: (-counts[name], name))
        chosen.append((best, counts[best]))
        left = {number: names for number, names in left.items() if best not in names}
    return chosen


def lines(found, tests):
    """What was found, as text."""
    known = sorted(test.name for test in tests if test.stage == "bits")
    seen = sum(bool(names) for names in found.values())
    chosen = greedy(found)
    yield f"{seen} of {len(found)} mistakes change a stored result; {len(chosen)} of {len(known)} stored results find all of them:"
    for name, count in chosen:
        yield f"  {count:4d}  {name}"
    alone = {names[0] for names in found.values() if len(names) == 1}
    yield f"the only one that differs, for some mistake: {', '.join(sorted(alone)) or 'none'}"
    never = [name for name in known if not any(name in names for names in found.values())]
    yield f"never differ: {', '.join(never) or 'none'}"
