"""The class reference: Doxygen with doxygen-awesome-css, all files local."""

import os
import re
import shutil
import subprocess
import sys
import tempfile

AWESOME = "/usr/share/doxygen-awesome-css"
MATHJAX = "/usr/share/javascript/mathjax"


def build(root, folder):
    if not shutil.which("doxygen") or not os.path.isdir(AWESOME):
        sys.exit("site: the classes need: apt-get install doxygen doxygen-awesome-css graphviz (or --no-reference)")
    target = os.path.join(folder, "reference")
    with open(os.path.join(root, "doc", "Doxyfile.in")) as file:
        settings = file.read().replace("@PROJECT_SOURCE_DIR@", root).replace("@PROJECT_VERSION@", version(root))
    # the rest of the site has the documents
    settings = re.sub(r"^(OUTPUT_DIRECTORY|INPUT|USE_MDFILE_AS_MAINPAGE) .*\n", "", settings, flags=re.M)
    with tempfile.TemporaryDirectory() as scratch:
        main = os.path.join(scratch, "main.dox")
        with open(main, "w") as file:
            file.write('/** @mainpage Classes\n The library, by its rooms (<a href="../doc/architecture.html">architecture</a>): '
                       '<a href="namespaces.html">namespaces</a>, which are the rooms; <a href="annotated.html">classes</a>; '
                       '<a href="hierarchy.html">who derives from whom</a>, such as plug-ins from their interface; <a href="files.html">files</a>. '
                       '<a href="../index.html">Back to the site</a>. */\n')
        settings += "\n".join((
            "", "OUTPUT_DIRECTORY = " + scratch, "INPUT = %s/include %s/source %s" % (root, root, main), "HTML_OUTPUT = html",
            "HTML_EXTRA_STYLESHEET = %s/doxygen-awesome.css %s/doxygen-awesome-sidebar-only.css" % (AWESOME, AWESOME),
            "GENERATE_TREEVIEW = YES", "DISABLE_INDEX = NO", "FULL_SIDEBAR = NO", "HTML_COLORSTYLE_SAT = 100", "SEARCHENGINE = YES", "VERBATIM_HEADERS = NO",
            # one small picture a class, who derives from whom; those of files would take an hour
            "HAVE_DOT = %s" % ("YES" if shutil.which("dot") else "NO"), "DOT_IMAGE_FORMAT = svg", "DOT_TRANSPARENT = YES", "CLASS_GRAPH = YES",
            "COLLABORATION_GRAPH = NO", "INCLUDE_GRAPH = NO", "INCLUDED_BY_GRAPH = NO", "DIRECTORY_GRAPH = NO", "GROUP_GRAPHS = NO", "WARNINGS = NO", ""))
        if has_formulas(root):
            settings += "USE_MATHJAX = YES\nMATHJAX_RELPATH = ../mathjax/\n"
            shutil.copytree(MATHJAX, os.path.join(folder, "mathjax"), symlinks=False)
        doxyfile = os.path.join(scratch, "Doxyfile")
        with open(doxyfile, "w") as file:
            file.write(settings)
        subprocess.run(["doxygen", doxyfile], check=True, stdout=subprocess.DEVNULL)
        shutil.move(os.path.join(scratch, "html"), target)


def version(root):
    with open(os.path.join(root, "CMakeLists.txt")) as file:
        found = re.search(r"VERSION (\d+(?:\.\d+)+)", re.sub(r"cmake_minimum_required\(.*?\)", "", file.read(), flags=re.S))
    return found[1] if found else ""


def has_formulas(root):
    r"""Whether a comment has LaTeX, \f$ or \f[: without, MathJax would be 50 MB for nothing."""
    for folder in ("include", "source"):
        for path, _, names in os.walk(os.path.join(root, folder)):
            for name in names:
                with open(os.path.join(path, name)) as file:
                    if re.search(r"[\\@]f[$\[]", file.read()):
                        return True
    return False
