"""Maps of lifts of a noisy surface that accelerates, as in Fig 4.13: which of them did not pop through."""
import numpy as np

from remote_touch import theory

CONTACT_RADIUS_M = 0.005  # r_c
NOISE, ACCELERATION = ("r_c", "standard deviation of the noise"), ("r_c/s^2", "acceleration of the lift")
SHARE = ("1", "share of lifts that did not pop through")


class LiftMap:
    """The outcomes of a sweep over noise and acceleration, for each cell: arrays noise (r_c) and acceleration (r_c/s^2), counts of
    lifts (held, lost, unknown), and survived, the share of those that did not pop through.

    measure: popped_through of the proxy or of the tool.
    """

    def __init__(self, made, measure):
        popped = made[measure]
        axes = np.meshgrid(*(made[name].values for name in popped.dims[:2]), indexing="ij")
        self.noise, self.acceleration = (axis.ravel() / CONTACT_RADIUS_M for axis in axes)
        outcomes = popped <= 0.5, popped > 0.5, np.isnan(popped)
        self.counts = np.transpose([outcome.sum("replicate").values.ravel() for outcome in outcomes])
        self.runs = self.counts.sum(axis=1)
        self.survived, self.low, self.high = np.transpose([theory.estimated_fraction(*of_cell) for of_cell in self.counts.tolist()])

    def add_to(self, s, end=""):
        """Adds the map, and the cells in which more than half of the lifts survived: tables map... and survived..."""
        s.table(f"map{end}", "lifts that did not pop through", noise=(self.noise, *NOISE),
                acceleration=(self.acceleration, *ACCELERATION), survived=(self.survived, *SHARE),
                survived_low=(self.low, "1", "lower end of its 95 % interval"),
                survived_high=(self.high, "1", "upper end of its 95 % interval"),
                runs=(self.runs.astype(float), "1", "number of lifts"))
        more = self.survived > 0.5
        s.table(f"survived{end}", "cells whose lift did not pop through", noise=(self.noise[more], *NOISE),
                acceleration=(self.acceleration[more], *ACCELERATION))
