"""Parameters as `alluvium --print-parameters` writes them, and which of them a scene sets."""

import collections
import html
import os
import re
import subprocess

# path: names of sections and of the parameter; allowed: in words; scenes: who sets it, filled by others
Parameter = collections.namedtuple("Parameter", "path prose allowed default scenes")


def read(program):
    """All parameters of the program, by path, in its order."""
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    printed = subprocess.run([program, "--print-parameters"], stdout=subprocess.PIPE, text=True, check=True, env=environment).stdout
    found, section, lines = {}, [], []
    for line in printed.splitlines():
        line = line.strip()
        if line.startswith("#"):
            lines.append(line[1:].strip())
        elif line.startswith("subsection "):
            section.append(line[len("subsection "):])
            lines = []
        elif line == "end":
            section.pop()
        elif line.startswith("set "):
            name, _, default = line[4:].partition("=")
            path = (*section, name.strip())
            prose, _, allowed = "\n".join(lines).partition("Allowed: ")
            found[path] = Parameter(path, prose.strip(), " ".join(allowed.split()), default.strip(), [])
            lines = []
    return found


def anchor(path):
    return re.sub(r"[^a-z0-9]+", "-", "/".join(path).lower()).strip("-")


def statements(text):
    """(line, path or None) of each line of a parameter file or of a piece of one; path is what the line sets."""
    section, out, continued = [], [], False
    for line in text.splitlines():
        statement = line.split("#")[0].strip()
        path = None
        if not continued:
            if statement.startswith("subsection "):
                section.append(statement[len("subsection "):].strip())
            elif statement == "end" and section:
                section.pop()
            elif statement.startswith("set ") and "=" in statement:
                path = (*section, statement[4:].split("=")[0].strip())
        continued = statement.endswith("\\")
        out.append((line, path))
    return out


def is_scene(text):
    return bool(re.search(r"^\s*(subsection [A-Z]|set [A-Z][\w ]*=|include \S+\.prm)", text, re.M))


def highlight(text, known, to_parameters, to_scene=lambda name: None):
    """HTML of a scene: what it sets is a link into the page `to_parameters`. Unknown names, as in pieces without their section, are not."""
    out = []
    for line, path in statements(text):
        code, hash_, comment = line.partition("#")
        code = html.escape(code)
        if path and path in known:
            name = html.escape(path[-1])
            code = code.replace(name, '<a href="%s#%s">%s</a>' % (to_parameters, anchor(path), name), 1)
        include = re.match(r"\s*include\s+(\S+)", code)
        if include and to_scene(include[1]):
            code = code.replace(include[1], '<a href="%s">%s</a>' % (to_scene(include[1]), include[1]))
        code = re.sub(r"^(\s*)(subsection|end|set|include)\b", r"\1<b>\2</b>", code)
        out.append(code + ("<i>#%s</i>" % html.escape(comment) if hash_ else ""))
    return "\n".join(out)
