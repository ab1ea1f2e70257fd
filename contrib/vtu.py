"""What scripts of this folder import as vtu: alluvium.vtu of contrib/python."""

import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "python"))
from alluvium.vtu import Grid, main, read_pieces, read_pvd, read_vtu  # noqa: E402, F401

if __name__ == "__main__":
    main(sys.argv[1:])
