"""What `Accuracy` chooses: from the results of doc/lab/accuracy into source/scene/accuracy_table.h, and into README.md.

Each kind of scene has groups of parameters, and each group levels, from loose to tight. The study runs its scenes with one group at a time
at other levels than a tight base; what a result then differs by from the group's tightest level is the error of that level alone. Of an
accuracy each group may use its share, and takes the loosest level that does with it on all scenes of its kind."""

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
STEPS = {t: [("Time/Time step", "auto"), ("Time/Automatic time step/Tolerance", t)] for t in ("1", "0.2", "0.05", "0.01")}
CONTACTS = {c: [("Contacts/Residual tolerance", c), ("Contacts/Largest violation", v)] for c, v in (("1e-1", "0.5"), ("1e-2", "0.5"), ("1e-3", "0.1"), ("4e-5", "0.01"))}
IN_FLUID = {"time step": STEPS, "contacts": {level: CONTACTS[level] for level in list(CONTACTS)[1:]},
            "coupling": {t: [("Coupling/Time scheme: iterated/Tolerance", t)] for t in ("0.1", "0.01")},
            "linear solver": {t: [("Fluid/Linear solver/Tolerance", t)] for t in ("1e-3", "1e-4", "1e-6")}}
EVEN = {**IN_FLUID, "cells": {h + " d": even(h) for h in ("8", "4", "2", "1")}}

# group: {level: settings}, from loose to tight
LEVELS = {
    "bed": {**IN_FLUID, "cells": {"4 d": at_faces("4"), "2 d": at_faces("2"), "1 d": at_faces("1"), "0.5 d": at_faces("0.5") + SMOOTH}},
    "suspension": EVEN,
    "other": EVEN,
    "dry": {"time step": STEPS, "contacts": CONTACTS},
}
BASE = {"time step": "0.05", "contacts": "4e-5", "coupling": "0.01", "linear solver": "1e-6", "cells": {"bed": "1 d", "suspension": "2 d", "other": "2 d"}}
COARSER = {"filter": "cells"}  # a group of the table: that of LEVELS with which it is chosen
# chosen as for another kind, whose scenes tell better
AS_FOR = {("suspension", "contacts"): "other", ("suspension", "coupling"): "other", ("suspension", "linear solver"): "bed", ("other", "linear solver"): "bed"}


def base(kind):
    return {group: BASE[group][kind] if group == "cells" else BASE[group] for group in LEVELS[kind]}


def settings(kind, levels):
    """{'Section/Name': value} of {group: level}."""
    return {name: value for group, level in levels.items() for name, value in LEVELS[kind][group][level]}


# --- choosing

# Of the accuracy that is asked for, what each group may use. Errors seldom add up; what is chosen is run as a whole, too
SHARES = {"cells": 1.0, "time step": 0.5, "contacts": 0.1, "coupling": 0.1, "linear solver": 0.1}


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
    """{level: {quantity: what it differs by from the tightest level}}, from loose to tight, on the scenes that tell."""
    module, found = study.module, {level: {} for level in LEVELS[kind][group]}
    tightest = list(found)[-1]
    for scene, (of, quantities) in module.SCENES.items():
        if of != AS_FOR.get((kind, group), kind) or group not in module.groups_of(scene):
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
                allowed = lambda name: max(SHARES[group] * target, results.floor(name))  # equally good runs differ by the floor
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
    values = {}
    for of, wanted, group, pairs, _ in rows():
        if (of, wanted) == (kind, accuracy):
            values[COARSER.get(group, group)] = values.get(COARSER.get(group, group), []) + pairs
    return {group: next(level for level, settings in LEVELS[kind][group].items() if [list(pair) for pair in settings] == pairs) for group, pairs in values.items()}


def table(choices):
    """Rows of the table: the filter, chosen with the cells, is a group that a scene may have its own of."""
    out = []
    for c in choices:
        parts = {c.group: []}
        for pair in LEVELS[c.kind][c.group][c.level]:
            parts.setdefault("filter" if pair[0].startswith("Coupling/Filter") else c.group, []).append(list(pair))
        out += [[c.kind, c.accuracy, group, pairs, c.reason] for group, pairs in parts.items()]
    return out


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


def chosen_settings(kind, accuracy):
    return settings(kind, chosen_levels(kind, accuracy))


# --- README.md

def readme_table(study, results):
    """Lines: for each accuracy what is chosen, how far off it is, and what it costs."""
    module = study.module
    out = ["| `Accuracy` | it chooses: error of a step, of contacts, cells (at a bed's faces; in a suspension; elsewhere) | largest error on five scenes, for what is known of them | their CPU time | over the cheapest found |", "|---|---|---|---|---|"]
    for asked in ACCURACIES:
        chosen = [chosen_levels(kind, asked) for kind in LEVELS]
        both = lambda group: "; ".join(dict.fromkeys(levels[group] for levels in chosen if group in levels))
        seconds = sum(results.cpu(module.CHOSEN, "%s: %s" % (scene, asked)) for scene in module.SCENES)
        _, error, name = module.worst(results, asked)
        costs = [module.cost(results, scene, asked) for scene in module.SCENES]
        out.append("| %s | %s, %s, %s | %s (%s) | %s s | %s to %s |" % (asked, both("time step"), both("contacts"), both("cells"), percent(error), name, number(seconds, 2), number(min(costs), 2), number(max(costs), 2)))
    return out


def write_readme(lines):
    name = os.path.join(ROOT, "README.md")
    with open(name) as file:
        text = file.read()
    start, rest = text.split(MARKS[0])
    with open(name, "w") as file:
        file.write(start + MARKS[0] + "\n\n" + "\n".join(lines) + "\n" + MARKS[1] + rest.split(MARKS[1])[1])


def renew(study, results_of):
    """Table and README.md from the study's results; what to do next, in lines."""
    results = results_of(study)
    choices = choose(study, results)
    before, now = [row[:4] for row in rows()], [row[:4] for row in table(choices)]
    write_table(choices, ", ".join(sorted({r.version for r in results})))
    yield TABLE
    if now != before:
        yield "it has changed: run `contrib/lab accuracy`, which runs what is chosen now, and `contrib/lab choose` once more"
        return
    write_readme(readme_table(study, results))
    yield os.path.join(ROOT, "README.md")
