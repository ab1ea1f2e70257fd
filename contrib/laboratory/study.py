"""What a study is: points to run, what is measured, what the page claims of it. A study is a folder with a study.py."""

import dataclasses
import importlib.machinery
import importlib.util
import math
import os
import re
from typing import Any, Callable, Optional


NOT_INSTALLED = "is not installed"  # what a program says that a point wants and that is not there: no failure of the point


@dataclasses.dataclass
class Point:
    """One run: a scene with settings {'Section/Name': value}, or a command.

    `{folder}` in settings and commands is the run's own folder, where `files` {name: text} are put first; `{build}` and `{root}` are those
    of the program and of the repository, `{bed}` is the table of grains of the study's `bed`, and `{peers}` the Python that has other programs.
    """

    series: str
    label: str
    settings: dict = dataclasses.field(default_factory=dict)
    x: Optional[float] = None  # of a map
    y: Optional[float] = None
    scene: Optional[str] = None  # default: the study's
    command: Optional[list] = None
    files: dict = dataclasses.field(default_factory=dict)
    reads: list = dataclasses.field(default_factory=list)  # other files that the result follows from: the point is run again if they change
    reference: bool = False
    default: bool = False  # what the program does if nobody says otherwise
    ranks: int = 1
    heavy: bool = False  # run with --heavy only; else what is known of it is shown, of whatever version
    shown: Optional[str] = None  # beside it on the chart; default: the label

    @property
    def name(self):
        return "%s, %s" % (self.series, self.label)


@dataclasses.dataclass
class Result:
    """What a point gave: status 'done' or 'failed', CPU seconds (user and system) of its process, measured values."""

    point: Point
    status: str
    exit_code: int
    reason: str
    cpu_s: float
    values: dict
    version: str
    key: str
    errors: dict = dataclasses.field(default_factory=dict)
    curves: dict = dataclasses.field(default_factory=dict)  # {panel: (xs, ys)}

    @property
    def done(self):
        return self.status == "done"


@dataclasses.dataclass
class Chart:
    """Error against CPU time. One panel an error that the study's error() names."""

    kind = "work-precision"
    log_x: bool = True


@dataclasses.dataclass
class Map:
    """A measured value over two parameters, one panel a series. Values up to `bound` are good; points that failed are crossed."""

    kind = "map"
    x: str = "x"  # names of the axes
    y: str = "y"
    value: str = ""  # of those that measure() gives
    title: str = ""  # of the colour bar
    bound: float = 1.0
    log: str = ""  # 'x', 'y', 'xy'; 'v' for the colours
    lines: Optional[Callable] = None  # lines(series) yields (label, xs, ys): theory
    stands: tuple = ()  # (x, y, label), then the series that it is for, if not all: where the default stands
    good: str = ""  # what points up to the bound, and above it, are called
    above: str = ""
    words: dict = dataclasses.field(default_factory=dict)  # {value: word}, where the value counts outcomes


@dataclasses.dataclass
class Curves:
    """Curves beside each other: those that the study's curves(run, point) gives of a run, and those that `beside` adds."""

    kind = "curves"
    panels: dict = dataclasses.field(default_factory=dict)  # {name: (title of x, title of y)}
    log: dict = dataclasses.field(default_factory=dict)  # {name: 'x', 'y' or 'xy'}
    # beside(panel, results) yields (label, xs, ys, 'line' or 'marks' or 'both'): theory, literature, values over a parameter; a number after
    # these is a colour: a theory has that of the marks that belong to it; the legend leaves out labels that begin with _
    beside: Optional[Callable] = None
    columns: int = 2


class Missing(Exception):
    """A point that a claim wants has not been run (in a quick study), or has failed."""


class Results:
    """All results of a study; what claims and texts look numbers up in."""

    def __init__(self, results, floor=0.0):
        """`floor`: the reference's own error, or {name: that}; what is below it is equally good."""
        self.all, self._floor = list(results), floor
        self.by_name = {(r.point.series, r.point.label): r for r in self.all}

    def __iter__(self):
        return iter(self.all)

    def of(self, series):
        return [r for r in self.all if r.point.series == series]

    def some(self, series, name=None):
        """Those of a series, with a value of this name if one is given; Missing if there are none."""
        found = [r for r in self.of(series) if name is None or name in r.values]
        if not found:
            raise Missing("%s was not run" % series)
        return found

    def get(self, series, label):
        found = self.by_name.get((series, label))
        if found is None:
            raise Missing("%s, %s was not run" % (series, label))
        return found

    def done(self, series, label):
        found = self.get(series, label)
        if not found.done:
            raise Missing("%s, %s %s" % (series, label, NOT_INSTALLED if NOT_INSTALLED in found.reason else "failed"))
        return found

    def failed(self, series, label):
        """1 if the point failed, 0 if not; Missing if what it is of is not there."""
        found = self.get(series, label)
        if NOT_INSTALLED in found.reason:
            raise Missing("%s, %s: %s" % (series, label, found.reason))
        return 0 if found.done else 1

    def value(self, series, label, name):
        return self.done(series, label).values[name]

    def cpu(self, series, label):
        return self.done(series, label).cpu_s

    def error(self, series, label, name="error"):
        errors = self.done(series, label).errors
        if name not in errors:
            raise Missing("%s, %s has no error of '%s', or the reference is missing" % (series, label, name))
        return errors[name]

    @property
    def default(self):
        """The result that stands for the program's defaults, or None."""
        return next((r for r in self.all if r.point.default), None)

    def error_names(self):
        return list(dict.fromkeys(name for r in self.all for name in r.errors))

    def compared(self, name):
        """Those that have an error of this name: the reference has none to show."""
        return [r for r in self.all if r.done and not r.point.reference and name in r.errors]

    def floor(self, name):
        return self._floor.get(name, 0.0) if isinstance(self._floor, dict) else self._floor

    def front(self, name):
        """Of these the ones than which none is both cheaper and more accurate, from dear to cheap."""
        best, found = math.inf, []
        clamped = lambda r: max(r.errors[name], self.floor(name))
        for r in sorted(self.compared(name), key=lambda r: (r.cpu_s, clamped(r))):
            if clamped(r) < best:
                best = clamped(r)
                found.append(r)
        return found[::-1]

    def cheapest(self, name, target):
        return min((r for r in self.compared(name) if max(r.errors[name], self.floor(name)) <= target * 1.001), key=lambda r: r.cpu_s, default=None)


@dataclasses.dataclass
class Claim:
    text: str
    value: Optional[float]
    relation: str
    bound: float
    holds: Optional[bool]  # None: not looked at in this (quick) study
    why: str = ""


RELATIONS = {"<": lambda a, b: a < b, "<=": lambda a, b: a <= b, ">": lambda a, b: a > b, ">=": lambda a, b: a >= b, "==": lambda a, b: a == b}


class Study:
    """A folder with study.py; doc/lab/README.md says what is in that."""

    def __init__(self, folder):
        self.folder = os.path.abspath(folder)
        self.name = os.path.basename(self.folder)
        loader = importlib.machinery.SourceFileLoader("study_" + re.sub(r"\W", "_", self.name), os.path.join(self.folder, "study.py"))
        self.module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
        loader.exec_module(self.module)
        text = (self.module.__doc__ or "").strip()
        self.title, _, self.prose = (part.strip() for part in text.partition("\n"))
        self.title = self.title.rstrip(".")
        self.chart = self.get("chart", Chart())
        self.order = self.get("order", 100)

    def get(self, name, otherwise=None):
        return getattr(self.module, name, otherwise)

    def points(self, quick):
        """References first: the others are compared with them, and they fill the caches of deposits."""
        points = list(self.module.points(quick))
        names = [(p.series, p.label) for p in points]
        twice = {name for name in names if names.count(name) > 1}
        if twice:
            raise ValueError("%s: two points are called %s" % (self.name, sorted(twice)))
        for point in points:
            point.scene = point.scene or self.get("scene")
            point.settings = {**self.get("always", {}), **point.settings}
        return sorted(points, key=lambda p: not p.reference)

    def compare(self, results):
        """Fill the errors of all results."""
        error = self.get("error")
        if error is None:
            return
        # a closed form, or what the point of reference measured
        exact = self.get("reference")
        given = next((r.values for r in results if r.point.reference and r.done), None)
        for r in results:
            r.errors = {}
            if r.done and (exact is not None or given is not None):
                found = error(r.values, exact if exact is not None else given)
                found = found if isinstance(found, dict) else {"error": found}
                r.errors = {name: float(value) for name, value in found.items() if value is not None and math.isfinite(value)}

    def claims(self, results):
        """What the page claims: a list of Claim."""
        found = []
        for text, value, relation, bound in self.get("claims", lambda r: [])(results):
            why = ""
            try:
                value = float(value() if callable(value) else value)
                holds = RELATIONS[relation](value, bound)
            except Missing as error:
                value, holds, why = None, None, str(error)
            found.append(Claim(text, value, relation, bound, holds, why))
        return found

    def says(self, results):
        """The page's two sentences."""
        says = self.get("says", "")
        try:
            return says(results) if callable(says) else says
        except (Missing, AttributeError, KeyError) as error:
            return "Not enough has been run to say anything: %s." % error


def all_studies(folder):
    """Studies of a folder, in the order that they give themselves."""
    names = [name for name in os.listdir(folder) if os.path.exists(os.path.join(folder, name, "study.py"))] if os.path.isdir(folder) else []
    return sorted((Study(os.path.join(folder, name)) for name in names), key=lambda s: (s.order, s.name))


def number(x: Any, digits=3):
    """For people: three digits, no e-notation where it can be helped."""
    if x is None:
        return ""
    if isinstance(x, float) and (math.isnan(x) or math.isinf(x)):
        return str(x)
    if x == 0 or 1e-3 <= abs(x) < 1e5:
        text = "%.*g" % (digits, x)
        return text if "e" not in text else "%.0f" % x
    return "%.*g" % (max(digits - 1, 1), x)


def percent(x):
    return "%s %%" % number(100 * x, 2)
