"""Read, draw, sweep and compare runs of Alluvium; see README.md.

alluvium.draw, which needs matplotlib, is imported by those who draw.
"""

from .comparison import Comparison, Difference, compare
from .run import Run, read_parameters, read_statistics, read_summary
from .sweeps import Point, sweep
from .vtu import Grid, read_pvd, read_vtu

__version__ = "0.1.0"
__all__ = ["Comparison", "Difference", "Grid", "Point", "Run", "compare", "read_parameters", "read_pvd", "read_statistics", "read_summary", "read_vtu", "sweep"]
