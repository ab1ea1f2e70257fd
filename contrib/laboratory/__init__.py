"""The laboratory: studies of doc/lab, run, charted and checked; see contrib/lab and doc/lab/README.md."""

import os
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
for _name in ("contrib", "contrib/python"):  # suspensions, alluvium
    sys.path.insert(0, os.path.join(ROOT, _name))
