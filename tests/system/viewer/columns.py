#!/usr/bin/python3
"""Numbers of a stored trace as JSON, read without the program: for each named column the rows at the given ticks.
Usage: columns.py TRACE.h5 TICK[,TICK...] COLUMN..."""
import json
import sys

import h5py

file, ticks, *names = sys.argv[1:]
with h5py.File(file) as trace:
    rows = {name: [trace["trace"][name][int(tick)].tolist() for tick in ticks.split(",")] for name in names}
json.dump(rows, sys.stdout)
