"""What the tutorial steps in doc/steps are run and checked with: see contrib/step and contrib/check-steps.

A step's folder has README.md (the text), scenes or a program, results.py, and what results.py printed when it was last run in full:
`output`, and `output-short` for the tests. results.py has one function,

    def results(step):                                   # a Step
        run = step.run("bed.prm", short=["Time/End time=0.01"])
        step.number("onset_mm", 1e3 * run.onset(), 0.05, "head at which water carries the bed [mm]")
        step.picture(figure, "bed.png")

In README.md

    <!-- from bed.prm -->        before a code block: it is literally in that file; lines `...` stand for what is left out
    <!-- printed by bed -->      before a code block: that run prints these lines, whatever the numbers in them
    15.2<!-- onset_mm -->        the number that results.py printed, within its tolerance and what rounding takes
"""

import importlib.machinery
import importlib.util
import os
import re
import resource
import shutil
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import vtu  # noqa: F401, which makes the package in contrib/python known
from alluvium import Run
from alluvium.draw import use_style

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
STEPS = os.path.join(ROOT, "doc", "steps")
IN_README = "step-6"  # the step whose numbers the table of the README at the top has
FREE = "free"  # a tolerance: of timings, which no test compares


def load(name, path):
    """The Python file at path, whatever its name, as a module."""
    loader = importlib.machinery.SourceFileLoader(name, path)
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


use_style()
plt.rcParams.update({"savefig.dpi": 110, "legend.frameon": False})


class Failure(Exception):
    pass


class Step:
    def __init__(self, number, build, short, scratch):
        self.name, self.build, self.short = "step-%s" % number, build, short
        self.folder = os.path.join(STEPS, self.name)
        self.scratch = scratch
        self.alluvium, self.scenes = os.path.join(build, "alluvium"), self.folder
        self.numbers, self.order, self.made, self.ran = {}, [], [], []

    def run(self, scene, name=None, settings=(), short=(), ranks=1, arguments=(), exit_code=0, keep=False):
        """Run a scene of the step's folder in the folder `name` (default: the scene's), with `short` settings too if that is asked for."""
        name = name or scene.rsplit(".", 1)[0]
        folder = os.path.join(self.scratch, name)
        if not keep:
            shutil.rmtree(folder, ignore_errors=True)
        command = ["mpirun", "-np", str(ranks)] if ranks > 1 else []
        command += [self.alluvium, os.path.join(self.scenes, scene), *arguments]
        settings = [*settings, *(short if self.short else ()), "Output/Output folder=" + folder, "Output/Progress=silent",
                    "Grains/Deposit: settled bed/Cache folder=" + os.path.join(self.scratch, "deposits")]
        for setting in settings:
            command += ["--set", setting]
        print("  running %s" % name, flush=True)
        self._call(command, name, exit_code)
        return Run(folder)

    def program(self, name, *arguments):
        """Run a program of the step, built by its CMakeLists.txt; returns what it prints."""
        path = os.path.join(self.build, "doc", "steps", self.name, name)
        if not os.path.exists(path):
            raise Failure("there is no %s: contrib/build %s makes it" % (path, name))
        return self._call([path, *arguments], name, 0)

    def build_against_installed(self):
        """Install the program in the scratch folder and build the step's own project against that: runs to come use both."""
        prefix, project = os.path.join(self.scratch, "installed"), os.path.join(self.scratch, "project")
        for folder in (prefix, project):
            shutil.rmtree(folder, ignore_errors=True)
        for component in ("program", "development"):
            self._call(["cmake", "--install", self.build, "--prefix", prefix, "--component", component], "install", 0)
        launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
        generator = ["-G", "Ninja"] if shutil.which("ninja") else []  # there may be no make
        self._call(["cmake", "-S", self.folder, "-B", project, "-DCMAKE_PREFIX_PATH=" + prefix, *generator, *launcher], "configure", 0)
        self._call(["cmake", "--build", project], "build", 0)
        self.alluvium, self.scenes = os.path.join(prefix, "bin", "alluvium"), project

    def _call(self, command, name, exit_code):
        self.ran.append(name)
        result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=self.scratch)
        with open(os.path.join(self.scratch, name + ".printed"), "w") as file:
            file.write(result.stdout)
        if result.returncode != exit_code:
            raise Failure("exit code %d of: %s\n%s" % (result.returncode, " ".join(command), result.stdout))
        return result.stdout

    def number(self, name, value, tolerance, text):
        """`tolerance` is absolute, or FREE."""
        self.numbers[name] = (float(value), tolerance, text)
        self.order.append(name)

    def picture(self, figure, name):
        """Pictures of the text are made by the full run."""
        figure.savefig(os.path.join(self.scratch, name), metadata={"Software": None})
        plt.close(figure)
        self.made.append(name)

    def format(self):
        return "".join("%s = %.5g +- %s  # %s\n" % (name, value, tolerance if tolerance == FREE else "%.2g" % tolerance, text)
                       for name, (value, tolerance, text) in ((name, self.numbers[name]) for name in self.order))


def execute(number, build, short, update, scratch):
    """Run a step; what does not fit what it gave when its text was written, a list."""
    step = Step(number, build, short, scratch)
    os.makedirs(scratch, exist_ok=True)
    module = load("results", os.path.join(step.folder, "results.py"))
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    module.results(step)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    step.number("cpu_s", after.ru_utime - before.ru_utime, FREE, "user time of all runs of this step")

    text = step.format()
    print(text, end="")
    name = os.path.join(step.folder, "output-short" if short else "output")
    if update:
        with open(name, "w") as file:
            file.write(text)
        if not short:
            renew_text(step.folder, step.numbers)
            if step.name == IN_README:
                renew_text(ROOT, step.numbers)
            for picture in step.made:
                shutil.copy(os.path.join(scratch, picture), step.folder)
    return compare(read_output(name), step.numbers) + check_printed(step)


def read_output(name):
    """{name: (value, tolerance, text)} of a file that Step.format() made."""
    numbers = {}
    with open(name) as file:
        for line in file:
            match = re.fullmatch(r"(\w+) = (\S+) \+- (\S+)  # (.*)\n", line)
            if not match:
                raise Failure("%s: cannot read '%s'" % (name, line.rstrip()))
            found, value, tolerance, text = match.groups()
            numbers[found] = (float(value), tolerance if tolerance == FREE else float(tolerance), text)
    return numbers


def compare(expected, found):
    problems = ["%s is new; renew the output (--update)" % name for name in found if name not in expected]
    for name, (value, tolerance, _) in expected.items():
        if name not in found:
            problems.append("%s has not been printed" % name)
        elif tolerance != FREE and not abs(found[name][0] - value) <= tolerance * (1 + 1e-9) + 1e-4 * abs(value):
            problems.append("%s is %.6g instead of %.6g +- %.2g" % (name, found[name][0], value, tolerance))
    return problems


# --- the text ---

BLOCK = re.compile(r"<!-- (from|printed by) (\S+) -->\n+```\w*\n(.*?)```", re.DOTALL)
NUMBER = re.compile(r"([-+]?(?:\d[\d,]*)?\.?\d+(?:e[-+]?\d+)?)<!-- (\w+) -->")
MARK = re.compile(r"<!--(?! *accuracy:| *end of accuracy) *(.*?) *-->")  # those of `contrib/lab choose` are its own
LINK = re.compile(r"\]\(([^)#\s]+)")


def read_text(folder):
    with open(os.path.join(folder, "README.md")) as file:
        return file.read()


def pieces(block):
    """Lists of lines, between the lines that say that something is left out."""
    result = [[]]
    for line in block.rstrip("\n").split("\n"):
        if line.strip() in ("...", "# ...", "// ..."):
            result.append([])
        else:
            result[-1].append(line.rstrip())
    return [piece for piece in result if any(piece)]


def contains(lines, piece):
    return any(lines[i:i + len(piece)] == piece for i in range(len(lines) - len(piece) + 1))


def strip_blank(piece):
    while piece and not piece[0]:
        piece = piece[1:]
    while piece and not piece[-1]:
        piece = piece[:-1]
    return piece


def as_number(written):
    return float(written.replace(",", ""))


def half_digit(written):
    """What rounding may take from a number in the text."""
    mantissa, _, exponent = written.replace(",", "").partition("e")
    return 0.5 * 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2])) * (1 + 1e-9)


def renew_text(folder, numbers):
    """Numbers of the text that are no longer what was printed, with as many digits as they had."""

    def renewed(match):
        written, name = match.groups()
        if name not in numbers or "e" in written or abs(as_number(written) - numbers[name][0]) <= half_digit(written):
            return match.group(0)
        return "%s<!-- %s -->" % (format(numbers[name][0], ",.%df" % len(written.partition(".")[2])), name)

    text = NUMBER.sub(renewed, read_text(folder))
    with open(os.path.join(folder, "README.md"), "w") as file:
        file.write(text)


def check_text(folder, output_folder=None):
    """What in a step's text does not fit its files and the output that is kept (in another folder, if that is given), a list."""
    text, problems = read_text(folder), []
    output = read_output(os.path.join(output_folder or folder, "output"))
    blocks = list(BLOCK.finditer(text))
    for block in blocks:
        kind, name, content = block.groups()
        if kind != "from":
            continue
        path = os.path.join(folder, name)
        if not os.path.exists(path):
            problems.append("there is no %s" % name)
            continue
        with open(path) as file:
            lines = [line.rstrip() for line in file]
        problems += ["not in %s:\n%s" % (name, "\n".join(piece)) for piece in map(strip_blank, pieces(content)) if not contains(lines, piece)]

    numbers = list(NUMBER.finditer(text))
    for written, name in (match.groups() for match in numbers):
        if name not in output:
            problems.append("%s<!-- %s -->: nothing of this name has been printed" % (written, name))
            continue
        value, tolerance, _ = output[name]
        if not abs(as_number(written) - value) <= half_digit(written) + (0 if tolerance == FREE else tolerance):
            problems.append("the text says %s for %s, which is %g" % (written, name, value))

    n_marks = len(MARK.findall(text))
    if n_marks != len(blocks) + len(numbers):
        used = {match.group(0) for match in blocks + numbers}
        problems += ["a mark that nothing belongs to: %s" % mark.group(0) for mark in MARK.finditer(text)
                     if not any(mark.group(0) in whole for whole in used)]
    for link in LINK.findall(text):
        if "://" not in link and not os.path.exists(os.path.join(folder, link)):
            problems.append("there is no %s" % link)
    return problems


def masked(line):
    """A line as a run printed it, without its numbers, paths and how wide its columns are."""
    return " ".join(re.sub(r"[-+]?(\d[\d.,]*|\.\d+)(e[-+]?\d+)?", "#", re.sub(r"[\w./-]*/", "", line)).split())


def check_printed(step):
    """Lines that the text says a run prints and that it did not print, whatever their numbers."""
    problems = []
    for kind, name, content in (block.groups() for block in BLOCK.finditer(read_text(step.folder))):
        if kind == "printed by" and (name in step.ran or not step.short):
            with open(os.path.join(step.scratch, name + ".printed")) as file:
                lines = {masked(line) for line in file}
            problems += ["%s does not print: %s" % (name, line) for piece in pieces(content) for line in piece
                         if line and masked(line) not in lines]
    return problems


def all_steps():
    names = [name for name in os.listdir(STEPS) if re.fullmatch(r"step-\d+", name)]
    return sorted((int(name[5:]) for name in names))
