"""What `Accuracy` chooses: from the results of doc/lab/accuracy into source/scene/accuracy_table.h, and into README.md.

Each kind of scene has a ladder of settings, from loose to tight. The study runs all of them on its scenes. An accuracy takes the cheapest that
does, as all tighter ones must, and as the same cells must in short steps: what is right where these are not is right by luck."""

import json
import os

from . import ROOT
from .study import number, percent

TABLE = os.path.join(ROOT, "source", "scene", "accuracy_table.h")
ACCURACIES = {"10 %": 0.1, "1 %": 0.01, "0.1 %": 0.001}
MARKS = "<!-- accuracy: contrib/lab choose -->", "<!-- end of accuracy -->"
FACES = "Mesh refinement/Criteria: bed faces/"


def even(h):
    return [("Mesh refinement/Criteria", "uniform"), ("Mesh refinement/Criteria: uniform/Cell size", h), ("Mesh refinement/Interval", "0")]


def at_faces(h):
    return [("Mesh refinement/Criteria", "bed faces"), (FACES + "Cell size at the bottom", h), (FACES + "Cell size at the top", h), (FACES + "Half width", "4"),
            (FACES + "Cell size far away", "8"), ("Mesh refinement/Interval", "20")]


SMOOTH = [("Coupling/Filter radius", "2.5 d"), ("Coupling/Filter shape", "smooth")]
VIOLATION = {"1e-1": "0.5", "1e-2": "0.5", "1e-3": "0.1", "4e-5": "0.01"}  # of the worst contact

# group: settings of a level
GROUPS = {
    "time step": lambda level: [("Time/Time step", "auto"), ("Time/Automatic time step/Tolerance", level)],
    "contacts": lambda level: [("Contacts/Residual tolerance", level), ("Contacts/Largest violation", VIOLATION[level])],
    "coupling": lambda level: [("Coupling/Time scheme: iterated/Tolerance", level)],
    "linear solver": lambda level: [("Fluid/Linear solver/Tolerance", level)],
    "cells": lambda level: at_faces(level[6:-2]) if level.startswith("faces ") else even(level[:-2]),
    "filter": lambda level: SMOOTH,
}
# rungs {group: level}, from loose to tight; in a suspension grains hardly meet, so that a tight tolerance of contacts costs nothing
rung = lambda *levels: dict(zip(GROUPS, levels))
LADDERS = {
    "bed": [rung("1", "1e-2", "0.1", "1e-3", "faces 4 d"), rung("1", "1e-2", "0.1", "1e-3", "faces 2 d"), rung("0.2", "1e-2", "0.1", "1e-3", "faces 1 d"),
            rung("0.2", "1e-3", "0.1", "1e-5", "faces 0.5 d", "smooth"), rung("0.05", "4e-5", "0.01", "1e-5", "faces 0.5 d", "smooth")],
    "suspension": [rung("1", "4e-5", "0.01", "1e-2", "8 d"), rung("1", "4e-5", "0.1", "1e-3", "4 d"), rung("1", "4e-5", "0.01", "1e-3", "2 d"),
                   rung("0.5", "4e-5", "0.1", "1e-3", "2 d"), rung("0.2", "4e-5", "0.1", "1e-3", "2 d"), rung("0.05", "4e-5", "0.01", "1e-4", "2 d"),
                   rung("0.02", "4e-5", "0.01", "1e-4", "1 d")],
    "other": [rung("1", "1e-2", "0.1", "1e-2", "4 d"), rung("0.2", "1e-3", "0.1", "1e-3", "4 d"), rung("0.2", "1e-3", "0.01", "1e-3", "2 d"),
              rung("0.05", "1e-3", "0.1", "1e-3", "2 d"), rung("0.05", "4e-5", "0.01", "1e-4", "2 d")],
    "dry": [rung("1", "1e-1"), rung("1", "1e-2"), rung("0.2", "1e-2"), rung("0.2", "1e-3"), rung("0.05", "1e-3")],
}


def name_of(levels):
    return ", ".join("%s %s" % item for item in levels.items())


def settings(levels):
    """{'Section/Name': value} of {group: level}."""
    return {name: value for group, level in levels.items() for name, value in GROUPS[group](level)}


# --- choosing

class Choice:
    """A rung for a kind of scene and an accuracy; its errors and those of the next looser one, {quantity: error}."""

    def __init__(self, kind, accuracy, levels, errors, looser):
        self.kind, self.accuracy, self.levels, self.errors, self.looser = kind, accuracy, levels, errors, looser

    @property
    def reason(self):
        found = "measured with all that is chosen: " + in_words(self.errors)
        return found + (" off; the next looser settings: %s" % in_words(self.looser) if self.looser else " off; these are the loosest that were tried")


def in_words(errors):
    return ", ".join("%s %s" % (name, percent(error)) for name, error in errors.items())


def choose(study, results):
    """A list of Choice. Throws Missing if a rung has not been run."""
    module, choices = study.module, []
    for kind, ladder in LADDERS.items():
        errors, seconds = [], []
        for levels in ladder:
            runs = [(results.done(module.LADDER, module.label_of(scene, levels)), names) for scene, (of, names) in module.SCENES.items() if of == kind]
            errors.append({name: run.errors[name] for run, names in runs for name in names})
            seconds.append(sum(run.cpu_s for run, _ in runs))
        for accuracy, target in ACCURACIES.items():
            bound = lambda name: max(target, results.floor(name))
            does = lambda at: all(error <= bound(name) for name, error in errors[at].items()) and module.cells_do(results, kind, ladder[at], bound)
            rungs = [at for at in range(len(ladder)) if all(does(tighter) for tighter in range(at, len(ladder)))] or [len(ladder) - 1]
            best = min(rungs, key=lambda at: seconds[at])
            choices.append(Choice(kind, accuracy, ladder[best], errors[best], errors[best - 1] if best else None))
    return choices


# --- the table in the program's source

def rows():
    """Of the table as it stands: [kind, accuracy, group, [[parameter, value]], reason]."""
    if not os.path.exists(TABLE):
        return []
    with open(TABLE) as file:
        lines = [line.strip().rstrip(",") for line in file if line.lstrip().startswith('{"')]
    return [json.loads(line.replace("{", "[").replace("}", "]")) for line in lines]


def chosen(kind, accuracy):
    """The rung that the program's table has, or None if it is no rung any more."""
    values = {name: value for of, wanted, _, pairs, _ in rows() if (of, wanted) == (kind, accuracy) for name, value in pairs}
    return next((levels for levels in LADDERS[kind] if settings(levels) == values), None)


def table(choices):
    """Rows of the table."""
    return [[c.kind, c.accuracy, group, [list(pair) for pair in GROUPS[group](level)], c.reason] for c in choices for group, level in c.levels.items()]


def write_table(choices, version):
    text = ["// Written by `contrib/lab choose` from doc/lab/accuracy/results.csv (%s): do not edit." % version, "#pragma once", "", "#include <alluvium/scene/accuracy.h>", "",
            "namespace alluvium::scene", "{", "  inline const std::vector<AccuracyChoice> &accuracy_table()", "  {",
            "    // clang-format off", "    static const std::vector<AccuracyChoice> table = {"]
    quoted = json.dumps
    for kind, accuracy, group, pairs, reason in table(choices):
        values = ", ".join("{%s, %s}" % (quoted(name), quoted(value)) for name, value in pairs)
        text.append("      {%s, %s, %s, {%s}, %s}," % (quoted(kind), quoted(accuracy), quoted(group), values, quoted(reason)))
    text += ["    };", "    // clang-format on", "    return table;", "  }", "} // namespace alluvium::scene", ""]
    with open(TABLE, "w") as file:
        file.write("\n".join(text))


# --- README.md

def readme_table(study, results):
    """Lines: for each accuracy what is chosen, how far off it is, and what it costs."""
    module = study.module
    kinds = {"bed": "flow through a bed", "suspension": "suspension", "other": "other flows", "dry": "dry grains"}
    out = ["| `Accuracy` | %s | largest error on five scenes, for what is known of them | their CPU time | over the cheapest found |" % " | ".join(kinds.values()),
           "|---" * (len(kinds) + 4) + "|"]
    for asked in ACCURACIES:
        levels = [chosen(kind, asked) for kind in kinds]
        cells = ["; ".join(found[group].replace("faces ", "") for group in ("time step", "contacts", "cells") if group in found) for found in levels]
        seconds = sum(results.cpu(module.LADDER, module.label_of(scene, chosen(module.SCENES[scene][0], asked))) for scene in module.SCENES)
        _, error, name = module.worst(results, asked)
        costs = [module.cost(results, scene, asked) for scene in module.SCENES]
        out.append("| %s | %s | %s (%s) | %s s | %s to %s |" % (asked, " | ".join(cells), percent(error), name, number(seconds, 2), number(min(costs), 2), number(max(costs), 2)))
    return out


def write_readme(lines):
    name = os.path.join(ROOT, "README.md")
    with open(name) as file:
        text = file.read()
    start, rest = text.split(MARKS[0])
    with open(name, "w") as file:
        file.write(start + MARKS[0] + "\n\n" + "\n".join(lines) + "\n" + MARKS[1] + rest.split(MARKS[1])[1])


def renew(study, results_of):
    """Table and README.md from the study's results; what was written, in lines."""
    results = results_of(study)
    choices = choose(study, results)
    before, now = [row[:4] for row in rows()], [row[:4] for row in table(choices)]
    write_table(choices, ", ".join(sorted({r.version for r in results})))
    yield TABLE + (": it has changed; build anew" if now != before else "")
    write_readme(readme_table(study, results))
    yield os.path.join(ROOT, "README.md")
