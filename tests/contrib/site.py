#!/usr/bin/python3
"""contrib/site: it builds, with all links and words right; scenes and parameters link to each other; the checks find what is wrong.

  site.py BUILD-FOLDER"""

import json
import os
import re
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PARTS = os.path.join(ROOT, "contrib", "site-parts")
sys.path.insert(0, PARTS)
sys.dont_write_bytecode = True
try:
    import markdown_it
    import pygments
except ImportError:
    print("skipped: python3-markdown-it or python3-pygments is missing")
    sys.exit(77)

import check
import parameters


def read(*path):
    with open(os.path.join(*path)) as file:
        return file.read()


def checks_find_mistakes(folder):
    pages = {"good.html": '<a href="other.html#here">x</a><a href="https://a.org">y</a>', "other.html": '<p id="here"></p>',
             "lost.html": '<a href="nowhere.html">x</a>', "place.html": '<a href="other.html#there">x</a>',
             "tag.html": "<p>the mean <phi> of it</p>", "net.html": '<script src="https://cdn.org/x.js"></script>'}
    for name, text in pages.items():
        with open(os.path.join(folder, name), "w") as file:
            file.write(text)
    found = check.links(folder)
    assert len(found) == 4 and all(any(words in line for line in found) for words in
                                   ("lost.html links to nowhere.html, which is not there", "tag.html: <phi> is taken for a tag", "place.html links to other.html#there, which has no such place",
                                    "net.html loads https://cdn.org/x.js from the network")), found


def scenes_as_pages():
    """What a line sets, and its link."""
    text = "set Gravity = 0, 1 # set Method\nsubsection Grains\n  set Density = 2630\n  subsection Deposit: lattice\n    set Box = \\\n set Seed = 1\n  end\n  set Nothing = 1\nend\n"
    paths = [path for _, path in parameters.statements(text) if path]
    assert paths == [("Gravity",), ("Grains", "Density"), ("Grains", "Deposit: lattice", "Box"), ("Grains", "Nothing")], paths
    page = parameters.highlight(text, {("Gravity",): 1, ("Grains", "Density"): 1}, "../p.html")
    assert '<a href="../p.html#gravity">Gravity</a> = 0, 1 <i># set Method</i>' in page and '<a href="../p.html#grains-density">Density</a>' in page, page
    assert page.count("<a ") == 2, page
    assert re.sub("<.*?>", "", page) == text.rstrip("\n"), page


def the_site(folder, build):
    result = subprocess.run([os.path.join(ROOT, "contrib", "site"), "--no-reference", "--build", build, folder], stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, text=True)
    assert result.returncode == 0, result.stdout
    page = read(folder, "parameters.html")
    scene = read(folder, "gallery", "fluidised-bed.html")
    known = parameters.read(os.path.join(build, "alluvium"))
    for path in known:
        assert ' id="%s"' % parameters.anchor(path) in page, path
    assert len({parameters.anchor(path) for path in known}) == len(known)
    # from every scene to what it sets, and back
    for name in os.listdir(os.path.join(ROOT, "prm")):
        if name.endswith(".prm"):
            scene = read(folder, "gallery", name[:-4] + ".html")
            for _, path in parameters.statements(read(ROOT, "prm", name)):
                if path:
                    assert path in known, (name, path)
                    assert 'href="../parameters.html#%s"' % parameters.anchor(path) in scene, (name, path)
                    part = page.split(' id="%s"' % parameters.anchor(path))[1].split('<div class="parameter"')[0]
                    assert 'href="gallery/%s.html"' % name[:-4] in part, (name, path)
    assert 'href="doc/steps/step-4/index.html"' in page.split(' id="contacts-residual-tolerance"')[1].split('<div class="parameter"')[0]
    # every document and step is there, and found by the search
    index = json.loads(read(folder, "search-index.js").split("=", 1)[1].strip().rstrip(";"))
    urls = {url.split("#")[0] for _, url, _ in index}
    for kind in ("guide", "theory", "developer", "reports"):
        for name in os.listdir(os.path.join(ROOT, "doc", kind)):
            if name.endswith(".md"):
                assert "doc/%s/%s.html" % (kind, name[:-3]) in urls, name
    assert "doc/steps/step-1/index.html" in urls and "parameters.html" in urls and "gallery/sedimentation.html" in urls, urls
    # again, over the old one; but not over something else
    assert subprocess.run([os.path.join(ROOT, "contrib", "site"), "--no-reference", "--build", build, folder], stdout=subprocess.DEVNULL).returncode == 0
    os.remove(os.path.join(folder, "search-index.js"))
    result = subprocess.run([os.path.join(ROOT, "contrib", "site"), "--build", build, folder], stderr=subprocess.PIPE, text=True)
    assert result.returncode == 1 and "holds something else" in result.stderr and os.path.exists(os.path.join(folder, "index.html")), result


with tempfile.TemporaryDirectory() as folder:
    checks_find_mistakes(folder)
scenes_as_pages()
with tempfile.TemporaryDirectory() as folder:
    the_site(folder, os.path.abspath(sys.argv[1]))
