"""Hypothesis must not take the compilation of a kernel for a slow example."""

from hypothesis import settings

settings.register_profile("kernels", deadline=None)
settings.load_profile("kernels")
