"""What `Accuracy` chooses: from the results of doc/lab/accuracy into source/scene/accuracy_table.h, and into README.md.

Each kind of scene has groups of parameters, and each group levels, from loose to tight. The study runs its scenes with one group at a time
at other levels than a tight base; what a result then differs by from the group's tightest level is the error of that level alone. Of an
accuracy each group may use its share, and takes the loosest level that does with it on all scenes of its kind."""

import csv
import json
import os
import re

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
STEPS = {t: [("Time/Time step", "auto"), ("Time/Automatic time step/Tolerance", t)] for t in ("1", "0.2", "0.05", "0.01")}
CONTACTS = {c: [("Contacts/Residual tolerance", c), ("Contacts/Largest violation", v)] for c, v in (("1e-1", "0.5"), ("1e-2", "0.5"), ("1e-3", "0.1"), ("4e-5", "0.01"))}
LINEAR = {t: [("Fluid/Linear solver/Tolerance", t)] for t in ("1e-2", "1e-3", "1e-4", "1e-6")}
COUPLING = {t: [("Coupling/Time scheme: iterated/Tolerance", t)] for t in ("0.3", "0.1", "0.03", "0.01")}

# group: {level: settings}, from loose to tight
LEVELS = {
    "bed": {"time step": STEPS, "contacts": CONTACTS, "coupling": COUPLING, "linear solver": LINEAR,
            "cells": {"4 d": at_faces("4"), "2 d": at_faces("2"), "1 d": at_faces("1"), "0.5 d": at_faces("0.5") + SMOOTH}},
    "even": {"time step": STEPS, "contacts": CONTACTS, "coupling": COUPLING, "linear solver": LINEAR, "cells": {h + " d": even(h) for h in ("8", "4", "2", "1")}},
    "dry": {"time step": STEPS, "contacts": CONTACTS},
}
BASE = {"time step": "0.05", "contacts": "4e-5", "coupling": "0.01", "linear solver": "1e-6", "cells": {"bed": "1 d", "even": "2 d"}}


def base(kind):
    return {group: BASE[group][kind] if group == "cells" else BASE[group] for group in LEVELS[kind]}


def settings(kind, levels):
    """{'Section/Name': value} of {group: level}."""
    return {name: value for group, level in levels.items() for name, value in LEVELS[kind][group][level]}


# --- choosing

# Of the accuracy that is asked for, what each group may use; the squares add up to 1, since errors seldom have the same sign
SHARES = {"cells": 0.85, "time step": 0.5, "contacts": 0.1, "coupling": 0.1, "linear solver": 0.1}


class Choice:
    """A level of a group, its own error on the scene where that is largest, and that of the next looser one."""

    def __init__(self, kind, accuracy, group, level, worst, looser):
        self.kind, self.accuracy, self.group, self.level, self.worst, self.looser = kind, accuracy, group, level, worst, looser

    @property
    def reason(self):
        """`worst` and `looser`: (error, quantity, level), or None."""
        of_it = "by itself %s of the %s" % (percent(self.worst[0]), self.worst[1]) if self.worst else "the tightest that was tried"
        of_next = "; with %s %s of the %s" % (self.looser[2], percent(self.looser[0]), self.looser[1]) if self.looser else ""
        return of_it + of_next


def own_errors(study, results, kind, group):
    """{level: {quantity: what it differs by from the tightest level}}, from loose to tight, on the scenes of a kind."""
    module, found = study.module, {level: {} for level in LEVELS[kind][group]}
    tightest = list(found)[-1]
    for scene, (of, quantities) in module.SCENES.items():
        if of != kind or group not in module.groups_of(scene):
            continue
        values = {level: results.done(*module.name_of(scene, group, level)).values for level in found}
        for level in found:
            for name in quantities:
                key = module.NAMES[name]
                found[level][name] = abs(values[level][key] - values[tightest][key]) / abs(module.reference[key] or 1.0)
    return found


def choose(study, results):
    """A list of Choice: the loosest level that, like all tighter ones, does with its share."""
    choices = []
    for kind, groups in LEVELS.items():
        for accuracy, target in ACCURACIES.items():
            for group in groups:
                errors = own_errors(study, results, kind, group)
                unknown = lambda name: results.floor(name) > 0.5 * target  # two runs differ by that, whatever their level
                allowed = lambda name: max(SHARES[group] * target, results.floor(name) if unknown(name) else 0.0)
                level = list(errors)[-1]
                for looser in list(errors)[-2::-1]:
                    if any(error > allowed(name) for name, error in errors[looser].items()):
                        break
                    level = looser
                of = lambda at: max(((error / allowed(name), error, name) for name, error in errors[at].items()))[1:]
                at = list(errors).index(level)
                next_looser = list(errors)[at - 1] if at else None
                choices.append(Choice(kind, accuracy, group, level, of(level) if level != list(errors)[-1] else None,
                                      (*of(next_looser), next_looser) if next_looser else None))
    return choices


# --- the table in the program's source

def rows():
    """Of the table as it stands: [kind, accuracy, group, [[parameter, value]], reason]."""
    if not os.path.exists(TABLE):
        return []
    with open(TABLE) as file:
        lines = [line.strip().rstrip(",") for line in file if line.lstrip().startswith('{"')]
    return [json.loads(line.replace("{", "[").replace("}", "]")) for line in lines]


def chosen_levels(kind, accuracy):
    """{group: level} that the program's table has."""
    found = {}
    for of, wanted, group, values, _ in rows():
        if (of, wanted) == (kind, accuracy):
            found[group] = next(level for level, settings in LEVELS[kind][group].items() if [list(pair) for pair in settings] == values)
    return found


def write_table(choices, version):
    text = ["// Written by `contrib/lab choose` from doc/lab/accuracy/results.csv (%s): do not edit." % version, "#pragma once", "", "#include <alluvium/scene/accuracy.h>", "",
            "namespace alluvium::scene", "{", "  inline const std::vector<AccuracyChoice> &accuracy_table()", "  {",
            "    // clang-format off", "    static const std::vector<AccuracyChoice> table = {"]
    quoted = json.dumps
    for c in choices:
        values = ", ".join("{%s, %s}" % (quoted(name), quoted(value)) for name, value in LEVELS[c.kind][c.group][c.level])
        text.append("      {%s, %s, %s, {%s}, %s}," % (quoted(c.kind), quoted(c.accuracy), quoted(c.group), values, quoted(c.reason)))
    text += ["    };", "    // clang-format on", "    return table;", "  }", "} // namespace alluvium::scene", ""]
    with open(TABLE, "w") as file:
        file.write("\n".join(text))
