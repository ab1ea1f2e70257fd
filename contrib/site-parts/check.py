"""What is wrong with a site: links that lead nowhere, things from the network, words misspelt."""

import html.parser
import os
import re
import shutil
import subprocess
import urllib.parse

WORDS = "numer,te,nd,fo,inout,strat,hist,ans,daa,som,ot,uint,sinc,fro,ser"  # names that codespell takes for mistakes

# that pages here have; another one is a `<` in the text that a browser takes for a tag
TAGS = set("html head meta title link script style body header nav a div span main h1 h2 h3 h4 h5 h6 p pre code b i em strong small ul ol li table thead tbody tr th td "
           "img br hr blockquote input button sub sup".split())


class Links(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.targets, self.names, self.loaded, self.unknown = [], set(), [], set()

    def handle_starttag(self, tag, attributes):
        if tag not in TAGS:
            self.unknown.add(tag)
        for key, value in attributes:
            if value and (key == "id" or (key == "name" and tag == "a")):
                self.names.add(value)
            elif value and key in ("href", "src", "data"):
                self.targets.append(value)
                if tag != "a":
                    self.loaded.append(value)


def links(folder):
    """Of every page: unknown tags, links between pages, their anchors, and that nothing is loaded from elsewhere. Doxygen's own pages: only that."""
    found, parsed = [], {}
    for path, _, names in os.walk(folder):
        for name in names:
            if name.endswith((".html", ".svg")):
                page = Links()
                with open(os.path.join(path, name), errors="replace") as file:
                    page.feed(file.read())
                parsed[os.path.join(path, name)] = page
    for name, page in sorted(parsed.items()):
        shown = os.path.relpath(name, folder)
        for target in page.loaded:
            if re.match(r"(https?:)?//", target):
                found.append("%s loads %s from the network" % (shown, target))
        if shown.startswith(("reference/", "mathjax/")):
            continue
        if name.endswith(".html"):
            found += ["%s: <%s> is taken for a tag; code goes between `...`" % (shown, tag) for tag in sorted(page.unknown)]
        for target in sorted(set(page.targets)):
            if re.match(r"[a-z]+:", target):
                continue
            path, _, anchor = target.partition("#")
            goal = os.path.normpath(os.path.join(os.path.dirname(name), urllib.parse.unquote(path))) if path else name
            if not os.path.isfile(goal):
                found.append("%s links to %s, which is not there" % (shown, target))
            elif anchor and goal in parsed and urllib.parse.unquote(anchor) not in parsed[goal].names:
                found.append("%s links to %s, which has no such place" % (shown, target))
    return found


def spelling(root, program):
    """Common misspellings, by codespell, in documents, scenes and the prose of parameters."""
    if not shutil.which("codespell"):
        return []
    files = [os.path.join(root, name) for name in ("README.md", "doc", "prm", "contrib/new-scene", "contrib/site", "contrib/gallery")]
    command = ["codespell", "--quiet-level=2", "--ignore-words-list=" + WORDS, "--skip=*.png,*.msh,*.json,*.csv,output,output-short"]
    found = subprocess.run(command + files, stdout=subprocess.PIPE, text=True).stdout
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    printed = subprocess.run([program, "--print-parameters"], stdout=subprocess.PIPE, check=True, env=environment).stdout
    found += subprocess.run(command + ["-"], input=printed, stdout=subprocess.PIPE).stdout.decode()
    return ["spelling: " + line for line in found.replace(root + "/", "").splitlines() if "==>" in line]
