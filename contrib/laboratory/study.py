"""What a study is: points to run, what is measured, what the page claims of it. A study is a folder with a study.py."""

import dataclasses
import importlib.machinery
import importlib.util
import math
import os
import re
import traceback
from typing import Any, Callable, Optional


NOT_INSTALLED = "is not installed"  # what a program says that a point wants and that is not there: no failure of the point


DIVERGED = 3  # exit code


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
    apart: tuple = ()  # series whose points have nothing to do with one another: no line joins them


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
    """A point that a claim wants has not been run (in a quick study), or what it needs is not installed."""


class Failed(Missing):
    """A point that a claim wants has been run and has failed, or is none of the study's: the claim does not hold."""


class Mistake(Exception):
    """A mistake in a study, or in how the laboratory was called: what is wrong, in one line."""


class Results:
    """All results of a study; what claims and texts look numbers up in."""

    def __init__(self, results, floor=0.0, names=None):
        """`floor`: the reference's own error, or {name: that}; what is below it is equally good. `names`: (series, label) of all points there can be."""
        self.all, self._floor, self.names = list(results), floor, names
        self.by_name = {(r.point.series, r.point.label): r for r in self.all}
        self.asked = set()  # whether these have failed

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
            if self.names is not None and (series, label) not in self.names:
                raise Failed("the study has no point '%s, %s'" % (series, label))
            raise Missing("%s, %s was not run" % (series, label))
        return found

    def done(self, series, label):
        found = self.get(series, label)
        if not found.done:
            if NOT_INSTALLED in found.reason:
                raise Missing("%s, %s %s" % (series, label, NOT_INSTALLED))
            raise Failed("%s, %s failed" % (series, label))
        return found

    def failed(self, series, label):
        """1 if the point failed, 0 if not; Missing if what it is of is not there."""
        found = self.get(series, label)
        if NOT_INSTALLED in found.reason:
            raise Missing("%s, %s: %s" % (series, label, found.reason))
        self.asked.add((series, label))
        return 0 if found.done else 1

    def value(self, series, label, name):
        values = self.done(series, label).values
        if name not in values:
            raise Failed("%s, %s has no value '%s'" % (series, label, name))
        return values[name]

    def cpu(self, series, label):
        return self.done(series, label).cpu_s

    def error(self, series, label, name="error"):
        errors = self.done(series, label).errors
        if name not in errors:
            reference = next((r for r in self.all if r.point.reference), None)
            lost = reference is not None and not reference.done and NOT_INSTALLED not in reference.reason
            raise (Failed if lost else Missing)("%s, %s has no error of '%s'%s" % (series, label, name, ": the reference failed" if lost else ", or the reference is missing"))
        return errors[name]

    def unexpected(self):
        """Those that failed otherwise than by divergence, which is a result, and of which no claim has asked whether they failed."""
        return [r for r in self.all if not r.done and r.exit_code != DIVERGED and NOT_INSTALLED not in r.reason and (r.point.series, r.point.label) not in self.asked]

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
        self.mistake = None  # the first of error(), kept until all results are written
        self.call(loader.exec_module, self.module)
        for name, what in (("points", "points(quick)"), ("measure", "measure(run, point)")):
            if not callable(self.get(name)):
                raise Mistake("%s/study.py has no %s" % (self.name, what))
        text = (self.module.__doc__ or "").strip()
        if not text:
            raise Mistake("%s/study.py has no text at its top, whose first line is the title" % self.name)
        self.title, _, self.prose = (part.strip() for part in text.partition("\n"))
        self.title = self.title.rstrip(".")
        self.chart = self.get("chart", Chart())
        self.order = self.get("order", 100)

    def get(self, name, otherwise=None):
        return getattr(self.module, name, otherwise)

    def call(self, function, *arguments):
        """What a function of the study gives; what it raises is a Mistake that names the line."""
        try:
            return function(*arguments)
        except (Missing, Mistake):
            raise
        except Exception as error:
            raise self.mistake_of(error) from error

    def mistake_of(self, error, where=""):
        file = os.path.join(self.folder, "study.py")
        lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == file]
        line = error.lineno if isinstance(error, SyntaxError) else lines[-1] if lines else None
        words = error.msg if isinstance(error, SyntaxError) else error
        return Mistake("%s/study.py%s%s: %s: %s" % (self.name, ", line %d" % line if line else "", where, type(error).__name__, words))

    def points(self, quick):
        """References first: the others are compared with them, and they fill the caches of deposits."""
        points = self.call(lambda: list(self.module.points(quick)))
        for point in points:
            if not isinstance(point, Point):
                raise Mistake("%s/study.py: points() has to yield Point(series, label, settings), got %r" % (self.name, point))
            if not isinstance(point.settings, dict):
                raise Mistake("%s/study.py: the settings of the point '%s' have to be {'Section/Name': value}, got %r" % (self.name, point.name, point.settings))
        names = [(p.series, p.label) for p in points]
        twice = {name for name in names if names.count(name) > 1}
        if twice:
            raise Mistake("%s/study.py: two points are called '%s'" % (self.name, ", ".join(sorted(twice)[0])))
        if sum(p.reference for p in points) > 1:
            raise Mistake("%s/study.py: two points are the reference: %s" % (self.name, " and ".join("'%s'" % p.name for p in points if p.reference)))
        for point in points:
            point.scene = point.scene or self.get("scene")
            if not point.command and not point.scene:
                raise Mistake("%s/study.py: the point '%s' has no scene, nor has the study" % (self.name, point.name))
            if not point.command and not os.path.isfile(os.path.join(self.folder, point.scene)):
                raise Mistake("%s/study.py: the scene of the point '%s', %s, is no file in %s" % (self.name, point.name, point.scene, self.folder))
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
                try:
                    found = error(r.values, exact if exact is not None else given)
                    found = found if isinstance(found, dict) else {"error": found}
                    found = {name: float(value) for name, value in found.items() if value is not None}
                except Exception as wrong:
                    self.mistake = self.mistake or self.mistake_of(wrong, ", error() of the point '%s'" % r.point.name)
                    continue
                r.errors = {name: value for name, value in found.items() if math.isfinite(value)}
                if len(r.errors) < len(found):
                    self.mistake = self.mistake or Mistake("%s/study.py: error() of the point '%s' gives a number that is not finite, %s; where there is no error to give, "
                                                           "give None" % (self.name, r.point.name, found))

    def claims(self, results):
        """What the page claims: a list of Claim."""
        found = []
        try:
            claims = self.call(lambda: list(self.get("claims", lambda r: [])(results)))
        except Missing as error:
            raise Mistake("%s/study.py: claims() looks a number up at once (%s); a claim's number has to be a function: put `lambda:` before it" % (self.name, error)) from error
        for claim in claims:
            if not isinstance(claim, tuple) or len(claim) != 4 or claim[2] not in RELATIONS:
                raise Mistake("%s/study.py: claims() has to yield (text, number or function, one of %s, bound), got %r" % (self.name, " ".join(RELATIONS), claim))
            text, value, relation, bound = claim
            why = ""
            try:
                value = float(self.call(value) if callable(value) else value)
                holds = bool(RELATIONS[relation](value, bound))
            except Failed as error:
                value, holds, why = None, False, str(error)
            except Missing as error:
                value, holds, why = None, None, str(error)
            found.append(Claim(text, value, relation, bound, holds, why))
        return found

    def check(self, results):
        """Raise the Mistake that error() has made, or one of the chart."""
        if self.mistake:
            raise self.mistake
        if self.chart.kind == "map":
            for r in results:
                if r.done and r.point.x is not None and self.chart.value not in r.values:
                    raise Mistake("%s/study.py: the chart shows '%s', which measure() does not give for the point '%s'" % (self.name, self.chart.value, r.point.name))

    def says(self, results):
        """The page's two sentences."""
        says = self.get("says", "")
        try:
            return says(results) if callable(says) else says
        except Missing as error:
            return "Not enough has been run to say anything: %s." % error
        except Exception as error:
            if all(r.done for r in results) and len(results.all) >= len(self.points(False)):
                raise self.mistake_of(error, ", says()") from error
            return "Not enough has been run to say anything: %s: %s." % (type(error).__name__, error)


def all_studies(folder):
    """Studies of a folder, in the order that they give themselves."""
    if not os.path.isdir(folder):
        raise Mistake("there is no folder of studies %s" % folder)
    names = [name for name in sorted(os.listdir(folder)) if os.path.exists(os.path.join(folder, name, "study.py"))]
    if not names:
        raise Mistake("%s holds no study: no folder in it has a study.py" % folder)
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
