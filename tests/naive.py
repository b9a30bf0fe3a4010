"""Slow, obvious twins of the compiled code. Read these first when a kernel looks wrong."""

import numpy as np

# ---------------------------------------------------------------- mesh
