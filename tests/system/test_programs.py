"""Prints the commands that run tests in few processes: a program of a module's tests once, and a program with a main() of
its own once for each test, since what it tests allows one run in a process. Reads `ctest --show-only=json-v1` from stdin."""
import json
import os
import sys

commands = [(*test["command"], "")[:2] for test in json.load(sys.stdin)["tests"]]  # some are a program alone
for program, chosen in dict.fromkeys((program, "" if os.path.basename(program).endswith("_tests") else chosen)
                                     for program, chosen in commands):
    print(program, chosen)
