"""Refinement of a control mesh: where it is looked at (√3), or everywhere (Loop, modified butterfly)."""

from .criteria import Criteria, Region
from .hidden import Hidden
from .sqrt3 import Sqrt3, Update, sqrt3
from .uniform import butterfly, loop

__all__ = ["Criteria", "Hidden", "Region", "Sqrt3", "Update", "butterfly", "loop", "sqrt3"]
