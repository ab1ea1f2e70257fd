#!/usr/bin/python3
"""contrib/gallery: every scene has a picture or says why not, and pictures and facts follow from a run.

  gallery.py PROGRAM"""

import json
import os
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
ENVIRONMENT = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")


def gallery(*arguments):
    return subprocess.run([os.path.join(ROOT, "contrib", "gallery"), *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


for name in os.listdir(os.path.join(ROOT, "prm")):
    if name.endswith(".prm"):
        with open(os.path.join(ROOT, "prm", name)) as file:
            wanted = "# PICTURE: none" not in file.read()
        for end in (".png", ".json"):
            assert os.path.exists(os.path.join(ROOT, "doc", "gallery", name[:-4] + end)) == wanted, "doc/gallery/%s%s: contrib/gallery makes it, or `# PICTURE: none` says that there is none" % (name[:-4], end)

with tempfile.TemporaryDirectory() as folder:
    for name, settings in (("dry-column-collapse", ["Grains/Deposit: settled bed/Number of grains=100"]), ("single-grain", ["Mesh refinement/Criteria: uniform/Cell size=4"])):
        run = os.path.join(folder, name)
        command = [sys.argv[1], os.path.join(ROOT, "prm", name + ".prm")]
        for setting in [*settings, "Output/Output folder=" + run, "Time/End time=0.004", "Output/Interval of pictures=0.002", "Output/Progress=silent",
                        "Grains/Deposit: settled bed/Cache folder="]:
            command += ["--set", setting]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, env=ENVIRONMENT)
        result = gallery("--from", run, "--to", os.path.join(folder, "pictures"), name)
        assert result.returncode == 0, result
        with open(os.path.join(folder, "pictures", name + ".json")) as file:
            facts = json.load(file)
        assert facts["grains"] == (100 if name.startswith("dry") else 1) and abs(facts["simulated_s"] - 0.004) < 1e-12, facts
        assert ("cells" in facts) == (name == "single-grain") and facts["cpu_s"] > 0 and facts["steps"] >= 4, facts
        with open(os.path.join(folder, "pictures", name + ".png"), "rb") as file:
            assert file.read(8) == b"\x89PNG\r\n\x1a\n"
    result = gallery("--from", folder, "no-such-scene")
    assert result.returncode == 1 and "there is no prm/no-such-scene.prm" in result.stderr, result
