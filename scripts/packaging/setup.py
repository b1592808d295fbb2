"""Beside pyproject.toml: the version, and that the wheel is for one kind of machine."""
import os

from setuptools import Distribution, setup


class BinaryDistribution(Distribution):
    def has_ext_modules(self):
        return True


setup(version=os.environ["REMOTE_TOUCH_VERSION"], distclass=BinaryDistribution)
