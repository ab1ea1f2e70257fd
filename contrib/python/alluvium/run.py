"""What a run has written, as arrays."""

from __future__ import annotations

import csv
import json
import os
from typing import Any, Iterable, Iterator

import numpy as np

from .vtu import Grid, read_pvd, read_vtu


def _number(text: str) -> float:
    """A cell of statistics.csv: empty, or a word, is NaN."""
    try:
        return float(text)
    except ValueError:
        return np.nan


def read_statistics(folder: str) -> dict[str, np.ndarray]:
    """Columns of statistics.csv by name; what is no number is NaN. Empty if there is no such file."""
    name = os.path.join(folder, "statistics.csv")
    if not os.path.exists(name):
        return {}
    with open(name, newline="") as file:
        rows = list(csv.reader(file))
    if not rows:
        return {}
    rows = [rows[0]] + [row for row in rows[1:] if len(row) == len(rows[0])]  # a run may be writing the last one
    return {name: np.array([_number(row[i]) for row in rows[1:]]) for i, name in enumerate(rows[0])}


def read_summary(folder: str) -> dict[str, Any]:
    """summary.json; empty if there is none."""
    name = os.path.join(folder, "summary.json")
    if not os.path.exists(name):
        return {}
    with open(name) as file:
        return json.load(file)


def read_parameters(lines: Iterable[str]) -> dict[str, str]:
    """{'Section/Name': value} of the lines of a parameter file without includes."""
    found: dict[str, str] = {}
    section: list[str] = []
    for line in lines:
        words = line.split("#")[0].strip()
        if words.startswith("subsection "):
            section.append(words[11:].strip())
        elif words == "end":
            section.pop()
        elif words.startswith("set ") and "=" in words:
            name, value = words[4:].split("=", 1)
            found["/".join(section + [name.strip()])] = value.strip()
    return found


class Run:
    """The output folder of a run. Pictures are read when they are asked for; the rest at once."""

    def __init__(self, folder: str) -> None:
        self.folder = str(folder)
        self.columns = read_statistics(self.folder)
        self.summary = read_summary(self.folder)

    def __repr__(self) -> str:
        return "Run(%r)" % self.folder

    @property
    def time(self) -> np.ndarray:
        """Times of the rows of statistics.csv [s]."""
        return self.columns["time_s"]

    @property
    def has_finished(self) -> bool:
        """Did it reach its end time?"""
        return self.summary.get("ended") == "finished"

    def last(self, name: str) -> float:
        """The last value of a column."""
        return float(self.columns[name][-1])

    def at(self, time: float, name: str) -> float:
        """A column at a time [s], linear between rows."""
        return float(np.interp(time, self.time, self.columns[name]))

    def cpu(self, *phases: str) -> float:
        """CPU seconds of the phases of this name in summary.json, or of all."""
        timing = self.summary["timing"]
        return sum(timing[phase]["cpu_s"] for phase in phases or timing if phase in timing)

    def times(self, what: str = "grains") -> np.ndarray:
        """Times of the pictures of `grains`, `fluid` or `walls` [s]."""
        return np.array([time for time, _ in self._series(what)])

    def grains(self) -> Iterator[tuple[float, Grid]]:
        """(time, grains) of each picture: a point a grain, fields id, radius, velocity, displacement ..."""
        return self.series("grains")

    def fluid(self) -> Iterator[tuple[float, Grid]]:
        """(time, fluid) of each picture: mesh, and fields velocity, pressure, void_fraction ... at its nodes."""
        return self.series("fluid")

    def series(self, what: str) -> Iterator[tuple[float, Grid]]:
        for time, files in self._series(what):
            yield time, read_vtu(files)

    def pictures(self, what: str) -> list[tuple[float, Grid]]:
        """All pictures of `grains`, `fluid` or `walls`, in a list."""
        return list(self.series(what))

    def picture(self, what: str, time: float) -> tuple[float, Grid]:
        """The picture that is nearest to a time [s]."""
        series = self._series(what)
        if not series:
            raise FileNotFoundError("%s has no pictures of %s." % (self.folder, what))
        found, files = min(series, key=lambda entry: abs(entry[0] - time))
        return found, read_vtu(files)

    def parameter(self, path: str) -> str:
        """A parameter as the run used it, 'Section/Name', from parameters.prm."""
        with open(os.path.join(self.folder, "parameters.prm")) as file:
            return read_parameters(file)[path]

    def _series(self, what: str) -> list[tuple[float, list[str]]]:
        name = os.path.join(self.folder, what + ".pvd")
        return read_pvd(name) if os.path.exists(name) else []
