#!/usr/bin/python3
"""contrib/check-docs: it finds long sentences, tables without a word before them and broken links, and nothing of that is in doc/."""

import importlib.machinery
import importlib.util
import os
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
TOOL = os.path.join(ROOT, "contrib", "check-docs")
sys.dont_write_bytecode = True
loader = importlib.machinery.SourceFileLoader("check_docs", TOOL)
check = importlib.util.module_from_spec(importlib.util.spec_from_loader("check_docs", loader))
loader.exec_module(check)


def of_sentences():
    thirty, more = " ".join(["Word"] + ["word"] * 29), " ".join(["Word"] + ["word"] * 30)
    assert check.long_sentences("# %s\n\n%s.\n\n    %s\n\n| %s |\n" % (more, thirty, more, more)) == []
    assert [n for _, n, _ in check.long_sentences("%s. %s.\n" % (thirty, more))] == [31]
    assert [line for line, _, _ in check.long_sentences("# A\n\n- Short.\n- %s\n  word word.\n" % thirty)] == [4]  # an item goes on in the next line
    assert check.sentences(["- **A b** is `c d e`, [f g](h.md). I `j`."]) == ["A b is `code`, f g.", "I `code`."]
    assert check.words("eps = 0.5 - a, or so") == 5


def of_tables():
    table = "| a |\n|---|\n| 1 |\n"
    assert check.bare_tables("# A\n\nWhat it says:\n\n%s" % table) == []
    assert check.bare_tables("# A\n\n%s\nText.\n" % table) == [3]
    assert check.bare_tables("Text.\n\n%s\n%s" % (table, table)) == [7]


def of_links(folder):
    page = os.path.join(folder, "a.md")
    for name, text in (("a.md", ""), ("b.md", "# One `word`, and two\n")):
        with open(os.path.join(folder, name), "w") as file:
            file.write(text)
    find = lambda text: [problem for _, problem in check.broken_links(page, text)]
    assert find("# Here\n\n[x](b.md) [y](b.md#one-word-and-two) [z](#here) [w](https://a.org/c)\n\n    [code](c.md)\n\n[here](#here)") == [
        "this page has no heading for #here"] * 2  # a.md itself is empty
    assert find("[x](c.md), [y](b.md#three)") == ["there is no c.md", "b.md has no heading for #three"]


of_sentences()
of_tables()
with tempfile.TemporaryDirectory() as folder:
    of_links(folder)
sys.exit(subprocess.run([TOOL]).returncode)
