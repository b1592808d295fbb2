"""What scripts/plot reports about its input."""


class PlotError(Exception):
    """What is wrong with the input, in one line."""
