"""Runs the points of a study, as many at a time as are asked for, and keeps what is done in its results.csv."""

import concurrent.futures
import csv
import dataclasses
import functools
import glob
import hashlib
import inspect
import json
import math
import os
import re
import select
import shutil
import signal
import statistics
import subprocess
import textwrap
import threading
import time

from . import ROOT
from .study import NOT_INSTALLED, Mistake, Result, Results
from alluvium import Run, read_parameters, sweeps

COLUMNS = ["series", "label", "x", "y", "status", "exit_code", "reason", "cpu_s"]  # then errors and values, then:
INTERRUPTED = "interrupted"  # such a point is run again
LAST = ["settings", "version", "key"]


class Printed:
    """What a point with a command has left: its folder and what it printed."""

    def __init__(self, folder, text):
        self.folder, self.text = folder, text


def version_of(alluvium):
    """(name for people, what tells programs apart)."""
    name = subprocess.run([alluvium, "--version"], capture_output=True, text=True, check=True, env=sweeps.environment()).stdout.splitlines()[0].strip()
    if "dirty" not in name:
        return name, name
    # the name does not tell: the files do
    linked = subprocess.run(["ldd", alluvium], capture_output=True, text=True).stdout
    files = [alluvium] + re.findall(r"=> (\S*liballuvium_core\S*)", linked)
    return name, name + " " + hashlib.sha256(b"".join(open(file, "rb").read() for file in files)).hexdigest()[:12]


def scene_text(path):
    """A scene with what it includes."""
    text = []
    if not os.path.isfile(path):
        raise Mistake("there is no scene %s" % path)
    with open(path) as file:
        for line in file:
            match = re.match(r"\s*include\s+(\S+)", line)
            text.append(scene_text(os.path.join(os.path.dirname(path), match[1])) if match else line)
    return "".join(text)


class Runner:
    def __init__(self, study, build, target, scratch, alluvium=None, jobs=1, limit=None, say=print, peers="/usr/bin/python3"):
        """`target`: folder of results.csv; `scratch`: where the runs go, and where deposits are kept; `peers`: the Python that has other programs."""
        self.study, self.build, self.target, self.say, self.peers = study, build, target, say, peers
        self.jobs = min(jobs, study.get("jobs", jobs))
        self.alluvium = alluvium or os.path.join(build, "alluvium")
        self.scratch, self.deposits = os.path.join(scratch, study.name), os.path.join(scratch, "deposits")
        self.limit = limit or study.get("limit", 300)
        self.version, self.identity = version_of(self.alluvium)
        self.lock, self.children = threading.Lock(), set()

    @property
    def file(self):
        return os.path.join(self.target, "results.csv")

    @property
    def file_of_curves(self):
        return os.path.join(self.target, "curves.csv")

    # --- what is kept

    def key(self, point):
        """Of all that a point's result follows from."""
        what = [self.identity, sorted((k, sweeps._text(v)) for k, v in point.settings.items()), point.command, sorted(point.files.items()), self.limit]
        if not point.command:
            what.append(scene_text(os.path.join(self.study.folder, point.scene)))
        if point.ranks > 1:
            what.append(point.ranks)
        for name in point.reads:
            with open(name) as file:
                what.append(file.read())
        if self.study.get("bed"):
            what.append(scene_text(os.path.join(self.study.folder, self.study.get("bed"))))
        what += [inspect.getsource(getattr(self.study.module, name)) for name in ("measure", "curves") if self.study.get(name)]
        return hashlib.sha256(json.dumps(what, default=str).encode()).hexdigest()[:16]

    def settings_of(self, point):
        """As results.csv has them: those that not all points have."""
        return "; ".join("%s = %s" % (k, sweeps._text(v)) for k, v in point.settings.items() if k not in self.study.get("always", {}))

    def write(self, results):
        """results.csv, whole, at once."""
        self.study.compare(results)
        errors = list(dict.fromkeys(name for r in results for name in r.errors))
        values = list(dict.fromkeys(name for r in results for name in r.values))
        os.makedirs(self.target, exist_ok=True)
        with open(self.file + ".new", "w", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(COLUMNS + ["error" if name == "error" else "error: " + name for name in errors] + ["value: " + name for name in values] + LAST)
            for r in results:
                settings = self.settings_of(r.point)
                writer.writerow([r.point.series, r.point.label, "" if r.point.x is None else "%.6g" % r.point.x, "" if r.point.y is None else "%.6g" % r.point.y,
                                 r.status, r.exit_code, r.reason, ("%.3f" if r.cpu_s >= 1 else "%.4g") % r.cpu_s] + [("%.4g" % r.errors[n]) if n in r.errors else "" for n in errors]
                                + [repr(r.values[n]) if n in r.values else "" for n in values] + [settings, r.version, r.key])
        os.replace(self.file + ".new", self.file)
        if not any(r.curves for r in results):
            return
        with open(self.file_of_curves + ".new", "w", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(["key", "series", "label", "panel", "x", "y"])
            for r in results:
                for panel, (xs, ys) in r.curves.items():
                    writer.writerows([r.key, r.point.series, r.point.label, panel, "%.6g" % x, "%.6g" % y] for x, y in zip(xs, ys))
        os.replace(self.file_of_curves + ".new", self.file_of_curves)

    # --- running

    def run(self, quick=False, again=False, heavy=False, given=None):
        """Results of all points: run, known, or read from what somebody else has run, `given` {label: folder}."""
        points = self.study.points(quick)
        known = {} if again else {row["key"]: row for row in read_rows(self.file) if row["reason"] != INTERRUPTED and NOT_INSTALLED not in row["reason"]}
        curves = read_curves(self.file_of_curves)
        settings = {(p.series, p.label): self.settings_of(p) for p in points}
        of_any_version = {(row["series"], row["label"]): row for row in read_rows(self.file) if row["settings"] == settings.get((row["series"], row["label"]))}
        wrong = [label for label in given or {} if label not in [p.label for p in points]]
        if wrong:
            raise Mistake("--read: %s has no point with the label '%s'" % (self.study.name, wrong[0]))
        if not heavy:
            points = [p for p in points if not p.heavy or (p.series, p.label) in of_any_version or p.label in (given or {})]
        took = {(row["series"], row["label"]): float(row["cpu_s"]) for row in read_rows(self.file)}  # also of other versions
        results, todo = {}, []
        for i, point in enumerate(points):
            row = known.get(self.key(point)) or (not heavy and point.heavy and of_any_version.get((point.series, point.label)))
            if point.label in (given or {}):
                results[i] = self.read(point, given[point.label])
            elif row:
                results[i] = from_row(row, point, curves)
            else:
                todo.append(i)
        self.say("%s: %d points, %d to run" % (self.study.name, len(points), len(todo)))
        if todo and self.study.get("bed"):
            self.bed  # before there are threads that want it
        start, waiting = time.monotonic(), set(todo)
        guess = lambda i: took.get((points[i].series, points[i].label)) or (statistics.median(took.values()) if took else 1.0)
        # the references alone: they fill the cache of deposits; without one, a run that is not counted does, where CPU times are compared
        if todo and self.study.chart.kind != "curves" and not any(p.reference for p in points) and not points[todo[0]].command:
            self.one(points[todo[0]])
        first, rest = [i for i in todo if points[i].reference], [i for i in todo if not points[i].reference]
        n = 0
        with concurrent.futures.ThreadPoolExecutor(max(1, self.jobs)) as pool:
            try:
                for batch in ([[i] for i in first] + [rest] if rest else [[i] for i in first]):
                    futures = {pool.submit(self.one, points[i]): i for i in batch}
                    for future in concurrent.futures.as_completed(futures):
                        i = futures[future]
                        results[i] = future.result()
                        n += 1
                        waiting.discard(i)
                        took[points[i].series, points[i].label] = results[i].cpu_s
                        self.write([results[k] for k in sorted(results)])
                        spent = sum(results[k].cpu_s for k in todo if k in results)
                        least = 0.05  # [s] of CPU time that any point takes, also one whose program could not be started
                        left = (time.monotonic() - start) * (sum(map(guess, waiting)) + least * len(waiting)) / (spent + least * n)
                        self.say("  %d/%d  %s: %s%s" % (n, len(todo), points[i].name, describe(results[i]), "" if n == len(todo) else "; %s left" % duration(left)))
            except BaseException:  # the user's Ctrl-C, too
                for future in futures:
                    future.cancel()
                self.kill()
                raise
        found = [results[i] for i in range(len(points))]
        self.write(found)
        return self.with_taken(found, quick)

    def known(self, quick=False):
        """What results.csv has of the study's points, of whatever version; not what has been run with other settings."""
        rows = {(row["series"], row["label"]): row for row in read_rows(self.file)}
        curves = read_curves(self.file_of_curves)
        there = [p for p in self.study.points(quick) if (p.series, p.label) in rows]
        found = [from_row(rows[p.series, p.label], p, curves) for p in there if rows[p.series, p.label]["settings"] == self.settings_of(p)]
        if len(found) < len(there):
            self.say("%s: left out, since results.csv has other settings for them: %d points" % (self.study.name, len(there) - len(found)))
        return self.with_taken(found, quick)

    def with_taken(self, results, quick):
        """Results, with those that the study takes from others."""
        results = results + list(self.study.get("taken", lambda quick: [])(quick))
        self.study.mistake = None
        self.study.compare(results)
        self.study.check(results)
        # what is taken from other studies is not known before it is there
        names = None if self.study.get("taken") else {(p.series, p.label) for way in (False, True) for p in self.study.points(way)}
        return Results(results, self.study.get("floor", 0.0), names)

    def kill(self):
        with self.lock:
            for child in self.children:
                os.killpg(child.pid, signal.SIGKILL)  # with what it has started

    @functools.cached_property
    def bed(self):
        """The table of grains that the program keeps of the bed in the study's scene `bed`: what all programs of a comparison read."""
        folder = os.path.join(self.scratch, "bed")
        shutil.rmtree(folder, ignore_errors=True)
        settings = {"Output/Interval of pictures": 0, "Grains/Deposit: settled bed/Cache folder": os.path.join(folder, "deposits")}
        os.makedirs(folder)
        exit_code, _, _ = self.call(sweeps.command(os.path.join(self.study.folder, self.study.get("bed")), settings, os.path.join(folder, "output"), alluvium=self.alluvium),
                                 os.path.join(folder, "printed"), folder)
        found = glob.glob(os.path.join(folder, "deposits", "*.csv"))
        if exit_code or len(found) != 1:
            with open(os.path.join(folder, "printed"), errors="replace") as file:
                raise Mistake("the bed of %s was not made: %s" % (self.study.name, file.read()[-500:]))
        return found[0]

    def one(self, point):
        key = self.key(point)
        folder = os.path.join(self.scratch, key)
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        for name, text in point.files.items():
            with open(os.path.join(folder, name), "w") as file:
                file.write(text)
        places = {"{folder}": folder, "{build}": self.build, "{root}": ROOT, "{study}": self.study.folder, "{peers}": self.peers}
        if self.study.get("bed"):
            places["{bed}"] = self.bed

        def filled(text):
            for name, path in places.items():
                text = text.replace(name, path) if isinstance(text, str) else text
            return text

        if point.command:
            command, output = [filled(word) for word in point.command], folder
        else:
            output = os.path.join(folder, "output")
            settings = {"Output/Interval of pictures": 0, "Grains/Deposit: settled bed/Cache folder": self.deposits,
                        **{name: filled(value) for name, value in point.settings.items()}}
            command = sweeps.command(os.path.join(self.study.folder, point.scene), settings, output, point.ranks, self.alluvium)
        printed = os.path.join(folder, "printed")
        try:
            exit_code, cpu_s, given_up = self.call(command, printed, folder)
        except OSError as error:
            exit_code, cpu_s, given_up = 127, 0.0, False
            with open(printed, "w") as file:
                file.write(str(error))
                if isinstance(error, FileNotFoundError) and command[0].startswith(self.build + os.sep):
                    file.write(": cmake --build %s --target %s makes it" % (self.build, os.path.basename(command[0])))
        with open(printed, errors="replace") as file:
            text = file.read()
        finished = exit_code == 0 and not given_up and (bool(point.command) or Run(output).has_finished)
        status, reason, values = ("done", "", {}) if finished else ("failed", self.why(exit_code, output, text, given_up), {})
        curves = {}
        if not given_up and (exit_code in (-signal.SIGINT, -signal.SIGTERM) or (not point.command and Run(output).summary.get("ended") == "interrupted")):
            status, reason = "failed", INTERRUPTED
        version = self.version
        if status == "done" or self.study.get("measure_failed", False):
            try:
                run = Printed(output, text) if point.command else Run(output)
                values, curves = self.measured(run, point)
                self.keep(output, point)
                cpu_s = values.pop("CPU [s]", cpu_s)
                version = self.study.get("program", lambda run, point: None)(run, point) or version
                bad = [name for name, value in values.items() if not math.isfinite(value)]
                if status == "done" and bad:
                    status, reason = "failed", "nothing was measured: %s" % ", ".join(bad)
            except Exception as error:
                if status == "done":
                    status, reason = "failed", "nothing was measured: %s" % self.study.mistake_of(error)
        values = {name: value for name, value in values.items() if math.isfinite(value)}
        shutil.rmtree(folder, ignore_errors=True)
        return Result(dataclasses.replace(point), status, exit_code, reason, cpu_s, values, version, key, curves=curves)

    def measured(self, run, point):
        """Values and curves of a run."""
        curves = self.study.get("curves", lambda run, point: {})(run, point)
        values = self.study.module.measure(run, point)
        if not isinstance(values, dict) or not values:
            raise ValueError("measure() has to give {name: number}, got %r" % (values,))
        return ({name: float(value) for name, value in values.items()},
                {panel: ([float(x) for x in xs], [float(y) for y in ys]) for panel, (xs, ys) in curves.items()})

    def keep(self, folder, point):
        """What the study wants to have of a run's folder, beside its page."""
        if self.study.get("keep"):
            self.study.module.keep(folder, point, self.target)

    def read(self, point, folder):
        """The result of a point that somebody has run into this folder."""
        run = Run(folder)
        if not run.summary:
            raise Mistake("--read: %s is no run's folder of output: it has no summary.json" % folder)
        if not run.has_finished:
            raise Mistake("--read: the run in %s has not finished" % folder)
        self.check_parameters(point, folder)
        values, curves = self.study.call(self.measured, run, point)
        self.keep(folder, point)
        cpu_s = point.ranks * sum(part["cpu_s"] for name, part in run.summary["timing"].items() if ": " not in name)
        with open(os.path.join(folder, "log.txt")) as file:
            version = re.search(r"alluvium \S+ \(.*?\)", file.readline())
        return Result(point, "done", 0, "", cpu_s, values, version[0] if version else "", self.key(point), curves=curves)

    def check_parameters(self, point, folder):
        """A run that is read must have the point's parameters, but for what it writes and where its files are."""
        name = os.path.join(folder, "parameters.prm")
        if not os.path.isfile(name):
            raise Mistake("--read: there is no %s, which says with what parameters it was run" % name)
        with open(name) as file:
            has = read_parameters(file)
        words = [word for name, value in point.settings.items() if "{" not in sweeps._text(value) for word in ("--set", "%s=%s" % (name, sweeps._text(value)))]
        asked = subprocess.run([self.alluvium, "--print-parameters", os.path.join(self.study.folder, point.scene), *words], capture_output=True, text=True, env=sweeps.environment())
        if asked.returncode:
            raise Mistake("--read: %s" % asked.stderr.strip())
        filled = {name for name, value in point.settings.items() if "{" in sweeps._text(value)}
        for name, value in read_parameters(asked.stdout.splitlines()).items():
            if name.startswith("Output/") or name.endswith("Cache folder") or name in filled or name not in has or plain(has[name]) == plain(value):
                continue
            raise Mistake("--read: the run in %s has '%s = %s', the point '%s' has '%s'" % (folder, name, has[name], point.name, value))

    def call(self, command, printed, folder):
        """Exit code (negative: a signal's) and CPU time, user and system, of a command, and whether it was given up."""
        with open(printed, "w") as file:
            child = subprocess.Popen(command, stdout=file, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, env=sweeps.environment(), cwd=folder, start_new_session=True)
        with self.lock:
            self.children.add(child)
        # no limit of the system's: a process that has one knows its own CPU time to a tick of the clock only, and programs time their phases by it
        ended, given_up = os.pidfd_open(child.pid), False
        while not select.select([ended], [], [], 1)[0]:
            if cpu_of_group(child.pid) > self.limit:
                given_up = True
                child.send_signal(signal.SIGXCPU)
                select.select([ended], [], [], 5)
                os.killpg(child.pid, signal.SIGKILL)  # what has not listened, and what it has started
        os.close(ended)
        _, status, usage = os.wait4(child.pid, 0)
        with self.lock:
            self.children.discard(child)
        child.returncode = os.waitstatus_to_exitcode(status)
        return child.returncode, usage.ru_utime + usage.ru_stime, given_up

    def why(self, exit_code, output, text, given_up=False):
        """A line: why a run failed."""
        if given_up:
            return "given up after %g s of CPU time" % self.limit
        reason = Run(output).summary.get("reason") or (text.strip().splitlines() or ["it said nothing"])[-1]
        if exit_code < 0:
            reason = "ended by signal %d (%s): %s" % (-exit_code, signal.strsignal(-exit_code), reason)
        elif exit_code == 0:
            reason = "exit code 0, but it has not finished: %s" % reason
        for path in (self.scratch, self.build, ROOT):
            reason = reason.replace(path + "/", "")
        return textwrap.shorten(str(reason), 400, placeholder=" ...")


def plain(text):
    """A parameter's value without regard to how its numbers are written."""
    def number(word):
        try:
            return "%.12g" % float(word)
        except ValueError:
            return word
    return " ".join(number(word) for word in re.split(r"[\s,]+", text.strip()))


def cpu_of_group(group):
    """CPU time of the processes of a group [s]."""
    ticks = 0
    for name in glob.glob("/proc/[0-9]*/stat"):
        try:
            with open(name) as file:
                fields = file.read().rsplit(")", 1)[1].split()
        except (OSError, IndexError):  # it has ended
            continue
        if int(fields[2]) == group:
            ticks += int(fields[11]) + int(fields[12])
    return ticks / os.sysconf("SC_CLK_TCK")


def read_rows(name):
    if not os.path.exists(name):
        return []
    with open(name, newline="") as file:
        return list(csv.DictReader(file))


def read_curves(name):
    """{key: {panel: (xs, ys)}} of curves.csv."""
    found = {}
    for row in read_rows(name):
        xs, ys = found.setdefault(row["key"], {}).setdefault(row["panel"], ([], []))
        xs.append(float(row["x"]))
        ys.append(float(row["y"]))
    return found


def from_row(row, point, curves=None):
    values = {name[7:]: float(value) for name, value in row.items() if name.startswith("value: ") and value}
    return Result(point, row["status"], int(row["exit_code"]), row["reason"], float(row["cpu_s"]), values, row["version"], row["key"],
                  curves=(curves or {}).get(row["key"], {}))


def describe(result):
    if not result.done:
        return "FAILED, exit code %d: %s" % (result.exit_code, result.reason)
    return "%.1f s CPU%s" % (result.cpu_s, "".join(", %s %.2g" % item for item in result.errors.items()))


def duration(seconds):
    return "%.0f s" % seconds if seconds < 100 else "%.1f min" % (seconds / 60) if seconds < 6000 else "%.1f h" % (seconds / 3600)
