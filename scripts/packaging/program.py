"""The command remote-touch of a wheel: the program that lies in this package."""
import os
import pathlib
import sys


def main():
    program = pathlib.Path(__file__).parent / "bin" / "remote-touch"
    os.execv(program, [sys.argv[0], *sys.argv[1:]])
