"""Pages of studies, the page of all of them, and the report."""

import base64
import html
import os
import platform
import re
import subprocess
import textwrap

from . import ROOT
from .study import Mistake, number, percent

TARGETS = (0.1, 0.01, 0.001)
LINE_BEFORE = "For each error, the cheapest setting found:"
CPU_SAYS = "CPU times are user and system time of the process, set-up included, on a machine that others used as well: trust their ratios within a fifth."
MARKS = "<!-- studies: contrib/lab index -->", "<!-- end of studies -->"


def hardware():
    """A line on the machine."""
    model = platform.processor() or platform.machine()
    try:
        with open("/proc/cpuinfo") as file:
            model = re.search(r"model name\s*: (.*)", file.read())[1]
    except (OSError, TypeError):
        pass
    return "%s, %d cores" % (" ".join(model.split()), os.cpu_count())


def libraries(alluvium):
    """What the program says it was linked with, in one line."""
    lines = subprocess.run([alluvium, "--version"], capture_output=True, text=True, env={**os.environ, "OMP_NUM_THREADS": "1"}).stdout.splitlines()
    return ", ".join(" ".join(line.split()) for line in lines[1:] if line.strip())


def commands(study):
    place = os.path.dirname(study.folder)
    return "contrib/lab %s%s%s" % (study.name, " --heavy" if any(p.heavy for p in study.points(False)) else "", "" if is_ours(study) else " --studies " + place)


def is_ours(study):
    """In doc/lab, whose studies ctest runs."""
    return os.path.dirname(study.folder) == os.path.join(ROOT, "doc", "lab")


def check_of(study):
    """The command that checks the claims on fewer points."""
    return "ctest -L chart -R %s" % study.name if is_ours(study) else commands(study) + " --quick --check"


def accuracy_table(study, results):
    """For 10 %, 1 %, 0.1 %: the cheapest setting, its error, what it costs."""
    names = results.error_names()
    if not names:
        return []
    default = results.default
    out = ["| %sat most | cheapest setting found | its error | CPU [s] | over the default's CPU |" % ("error of | " if names != ["error"] else "error "),
           "|---" * (5 + (names != ["error"])) + "|"]
    for name in names:
        for target in TARGETS:
            start = "| %s%s | " % ("" if names == ["error"] else name + " | ", percent(target))
            found = results.cheapest(name, target)
            if results.floor(name) > target * 1.001:
                out.append(start + "the reference is not known to this | | | |")
            elif found:
                ratio = number(found.cpu_s / default.cpu_s, 2) if default and default.done else ""
                out.append(start + "%s | %s | %s | %s |" % (found.point.name, shown_error(results, name, found), number(found.cpu_s), ratio))
            else:
                best = min(results.compared(name), key=lambda r: r.errors[name], default=None)
                out.append(start + ("none of these; the best, %s, has %s | | | |" % (best.point.name, percent(best.errors[name])) if best else "none | | | |"))
        if default and default.done and name in default.errors:
            on = default in results.front(name)
            out.append("| %sdefault | %s, %s the front | %s | %s | 1 |" % ("" if names == ["error"] else name + " | ", default.point.name, "on" if on else "not on",
                                                                             shown_error(results, name, default), number(default.cpu_s)))
    return out


def shown_error(results, name, result):
    return percent(result.errors[name]) if result.errors[name] > results.floor(name) else "< " + percent(results.floor(name))


def claims_table(claims):
    out = ["| what is claimed, and checked | measured | |", "|---|---|---|"]
    for claim in claims:
        verdict = {True: "holds", False: "**does not hold**" + (": " + claim.why if claim.why else ""), None: "not looked at: " + claim.why}[claim.holds]
        out.append("| %s | %s %s %s | %s |" % (claim.text, *shown_apart(claim), verdict))
    return out


def shown_apart(claim):
    """(value, relation, bound), with more digits where the two differ in these only."""
    digits = 3
    while claim.value is not None and claim.value != claim.bound and number(claim.value, digits) == number(claim.bound, digits) and digits < 12:
        digits += 1
    return number(claim.value, digits), claim.relation, number(claim.bound, digits)


def results_table(study, results):
    errors = results.error_names()
    values = list(dict.fromkeys(name for r in results for name in r.values))
    out = ["| | CPU [s] | " + " | ".join([("error" if e == "error" else "error of " + e) for e in errors] + values) + " |", "|---" * (2 + len(errors) + len(values)) + "|"]
    for r in results:
        if r.done:
            name = r.point.name + (" (reference)" if r.point.reference else "") + (" (default)" if r.point.default else "")
            out.append("| %s | %s | " % (name, number(r.cpu_s)) + " | ".join(["" if r.point.reference or e not in r.errors else percent(r.errors[e]) for e in errors]
                                                                                  + [number(r.values[v], 5) if v in r.values else "" for v in values]) + " |")
    return out


def failed_rows(failed):
    """A row for each point; where more than a few of a series failed with one exit code, a row for all these, with what the first one said."""
    groups, few = {}, 4
    for r in failed:
        groups.setdefault((r.point.series, r.exit_code), []).append(r)
    out = []
    for (series, exit_code), those in groups.items():
        why = lambda r: textwrap.shorten(r.reason.replace("|", "/"), 200, placeholder=" ...")
        if len(those) <= few:
            out += ["| %s | %d | %s |" % (r.point.name, exit_code, why(r)) for r in those]
        else:
            out.append("| %s, %d points: %s | %d | the first: %s |" % (series, len(those), "; ".join(r.point.label for r in those), exit_code, why(those[0])))
    return out


def not_run(study, results, quick):
    """Points that there is no result of."""
    return [p for p in study.points(quick) if (p.series, p.label) not in results.by_name]


def write_page(study, results, claims, folder, alluvium, is_drawn=True, quick=False):
    """README.md of a study; `is_drawn`: there is a picture of it."""
    failed = [r for r in results if not r.done]
    versions = sorted({r.version for r in results})
    out = ["# " + study.title, "", "<!-- written by %s -->" % commands(study), "", study.says(results), "",
           "[![%s](%s.png)](%s.svg)" % (study.title, study.name, study.name) if is_drawn else "No picture: there is nothing to draw.", ""]
    if study.prose:
        out += [study.prose, ""]
    table = accuracy_table(study, results)
    if table:
        out += ["## What an accuracy costs", "", LINE_BEFORE, ""] + table + [""]
    out += ["## Checked", "", "What this page claims, and what was measured of it; `%s` checks it on fewer points." % ("ctest -L chart" if is_ours(study) else check_of(study)), ""]
    out += claims_table(claims) + [""]
    out += ["## Failed", ""]
    said = "Points whose run has failed%s, and what the program said:" % ("; what was measured of it before is shown" if study.get("measure_failed") else "")
    out += ([said, "", "| point | exit code | why |", "|---|---|---|"] + failed_rows(failed) if failed else ["No point failed."]) + [""]
    missing = not_run(study, results, quick)
    if missing:
        some = "; ".join(p.name for p in missing[:5]) + ("; ..." if len(missing) > 5 else ".")
        out += ["Not run yet: %d of %d points%s: %s" % (len(missing), len(study.points(quick)), ", which `--heavy` runs" if all(p.heavy for p in missing) else "", some), ""]
    if study.chart.kind != "map":
        out += ["## All points", "", "CPU time, errors and what was measured, of all that ran:", ""] + results_table(study, results) + [""]
    out += ["## How to repeat it", "", "    %s              # %s of CPU time; with --quick less" % (commands(study), cpu_words(results)),
            "    %s    # its claims, on fewer points" % check_of(study), "",
            "Data: [results.csv](results.csv); what is run: [study.py](study.py). %s (%s), on %s, one process a point." % (", ".join(versions), libraries(alluvium), hardware()),
            study.get("cpu_says", CPU_SAYS), ""]
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "README.md"), "w") as file:
        file.write("\n".join(out))


def cpu_words(results):
    total = sum(r.cpu_s for r in results)
    return "%.0f s" % total if total < 100 else "%.0f min" % (total / 60)


def index(studies, results_of, folder, quick=False):
    """Renew the list of studies in README.md of doc/lab, between its marks."""
    out = []
    for study in studies:
        results = results_of(study)
        if not os.path.exists(os.path.join(folder, study.name, "README.md")):
            continue  # not finished yet
        out += ["### [%s](%s/README.md)" % (study.title, study.name), "", study.says(results), ""]
        if os.path.exists(os.path.join(folder, study.name, study.name + ".png")):
            out += ["[![%s](%s/%s.png)](%s/README.md)" % (study.title, study.name, study.name, study.name), ""]
        table = accuracy_table(study, results)
        out += [LINE_BEFORE, ""] + table + [""] if table else []
        failed = sum(not r.done for r in results)
        missing = len(not_run(study, results, quick))
        out += ["%d points%s%s, %s of CPU time." % (len(results.all), ", %d of them failed" % failed if failed else "", ", %d more not run yet" % missing if missing else "",
                                                     cpu_words(results)), ""]
    listed = ["- [%s](reports/%s): %s" % (title, os.path.basename(name), ", ".join("`%s`" % c for c in commands)) for title, name, commands in reports(os.path.join(folder, "reports"))]
    out += ["### Reports", "", "Tables with more text than a study has, each with the day and the command of its measurement.", "", *listed, ""] if listed else []
    name = os.path.join(folder, "README.md")
    text = "# Studies\n\n%s\n%s\n" % MARKS
    if os.path.exists(name):
        with open(name) as file:
            text = file.read()
    if any(text.count(mark) != 1 for mark in MARKS):
        raise Mistake("index: %s has to have the lines '%s' and '%s', once each: the list goes between them" % (name, *MARKS))
    start, rest = text.split(MARKS[0])
    with open(name, "w") as file:
        file.write(start + MARKS[0] + "\n\n" + "\n".join(out) + MARKS[1] + rest.split(MARKS[1])[1])


def reports(folder):
    """[(title, file, commands that measured what it says)] of the reports: tables with more text than a study has."""
    found = []
    for name in sorted(os.listdir(folder)) if os.path.isdir(folder) else []:
        if name.endswith(".md"):
            with open(os.path.join(folder, name)) as file:
                text = file.read()
            commands = re.findall(r"`((?:contrib/(?!environment)|ctest |build/tests/)[^`]*)`", text)
            found.append((text.split("\n")[0].replace("# Report: ", "").strip(), os.path.join(folder, name), list(dict.fromkeys(commands))))
    return found


def report(pages, target, alluvium):
    """One HTML file of pages [(title, file)], pictures inside it."""
    try:
        import markdown_it
    except ImportError:
        raise SystemExit("lab: the report needs python3-markdown-it")
    parser = markdown_it.MarkdownIt("commonmark", {"html": True}).enable("table")
    commit = subprocess.run(["git", "-C", ROOT, "describe", "--always", "--dirty", "--abbrev=12"], capture_output=True, text=True).stdout.strip() or "unknown"
    with open(os.path.join(ROOT, "contrib", "site-parts", "style.css")) as file:
        style = file.read()
    body = ["<h1>Laboratory</h1><p>Repository at %s. %s. On %s.</p><ul>" % (html.escape(commit), html.escape(libraries(alluvium)), html.escape(hardware()))]
    body += ['<li><a href="#s%d">%s</a></li>' % (i, html.escape(title)) for i, (title, _) in enumerate(pages)] + ["</ul>"]
    for i, (_, name) in enumerate(pages):
        folder = os.path.dirname(name)
        with open(name) as file:
            text = re.sub(r"<!--.*?-->", "", file.read(), flags=re.S)
        text = re.sub(r"\[(!\[.*?\]\(.*?\))\]\(.*?\)", r"\1", text)  # the picture's own link
        text = re.sub(r"(?<!!)\[([^\]]*)\]\((?![a-z]+:)[^)]*\)", r"\1", text)  # links into the repository lead nowhere from here
        page = re.sub(r'src="([\w./-]+\.png)"', lambda m: 'src="data:image/png;base64,%s"' % encoded(folder, m[1]), parser.render(text))
        body.append('<section id="s%d">%s</section>' % (i, page))
    os.makedirs(os.path.dirname(os.path.abspath(target)), exist_ok=True)
    with open(target, "w") as file:
        file.write('<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>Alluvium: laboratory</title><style>%s\nimg{max-width:100%%}</style></head><body><main>%s</main></body></html>\n'
                   % (style, "\n".join(body)))


def encoded(folder, picture):
    """A picture of the page in this folder; if a page of quick points has not kept it, that of the study in doc/lab."""
    name = os.path.join(folder, picture)
    if not os.path.exists(name):
        name = os.path.join(ROOT, "doc", "lab", os.path.basename(folder), picture)
    with open(name, "rb") as file:
        return base64.b64encode(file.read()).decode()
