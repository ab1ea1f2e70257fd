"""How much two runs differ."""

from __future__ import annotations

import argparse
import sys
from typing import NamedTuple

import numpy as np

from .run import Run


class Difference(NamedTuple):
    """Of a column: the largest difference at any time, over the largest value of the column, and when it is."""

    column: str
    relative: float
    time: float


class Comparison(NamedTuple):
    differences: list[Difference]  # the largest first
    only_in_first: list[str]  # columns
    only_in_second: list[str]
    from_time: float
    to_time: float  # both have this interval [s]

    @property
    def largest(self) -> float:
        return self.differences[0].relative if self.differences else 0.0

    def __str__(self) -> str:
        lines = ["from %g to %g s; largest difference over the largest value:" % (self.from_time, self.to_time)]
        lines += ["  %-45s %8.2e  at %g s" % difference for difference in self.differences]
        for names, which in ((self.only_in_first, "first"), (self.only_in_second, "second")):
            if names:
                lines.append("only in the %s: %s" % (which, ", ".join(names)))
        return "\n".join(lines)


def compare(first: Run, second: Run) -> Comparison:
    """Compare all columns of statistics.csv in the time that both runs have, at the times of the first."""
    begin, end = max(first.time[0], second.time[0]), min(first.time[-1], second.time[-1])
    inside = (first.time >= begin - 1e-12) & (first.time <= end + 1e-12)
    times = first.time[inside]
    if len(times) == 0:
        raise ValueError("%s and %s have no times in common." % (first.folder, second.folder))
    differences = []
    for name, values in first.columns.items():
        if name == "time_s" or name not in second.columns:
            continue
        a = values[inside]
        there = np.isfinite(second.columns[name])
        if not there.any() or not np.isfinite(a).any():
            continue
        b = np.interp(times, second.time[there], second.columns[name][there])
        difference = np.where(np.isfinite(a), np.abs(a - b), 0.0)
        size = max(np.nanmax(np.abs(a)), np.max(np.abs(b)))
        at = int(np.argmax(difference))
        differences.append(Difference(name, float(difference[at] / size) if size > 0 else 0.0, float(times[at])))
    differences.sort(key=lambda difference: -difference.relative)
    return Comparison(differences, sorted(set(first.columns) - set(second.columns)), sorted(set(second.columns) - set(first.columns)),
                      float(begin), float(end))


def main() -> None:
    parser = argparse.ArgumentParser(description="Say how much two runs differ; exit code 1 if more than the tolerance.")
    parser.add_argument("first", metavar="OUTPUT_FOLDER")
    parser.add_argument("second", metavar="OUTPUT_FOLDER")
    parser.add_argument("--tolerance", type=float, default=np.inf, help="relative to the largest value of each column (default: none)")
    arguments = parser.parse_args()
    runs = [Run(folder) for folder in (arguments.first, arguments.second)]
    for run in runs:
        if "time_s" not in run.columns or len(run.time) == 0:
            sys.exit("compare: '%s' has no statistics.csv with rows." % run.folder)
    found = compare(*runs)
    print(found)
    sys.exit(1 if found.largest > arguments.tolerance else 0)


if __name__ == "__main__":
    main()
