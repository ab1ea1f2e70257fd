"""Tests of the package, without the program: a small output folder and a program that is a script."""

import json
import os
import stat
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import numpy as np

import alluvium

PVD = '<VTKFile type="Collection"><Collection>%s</Collection></VTKFile>'
VTU = """<?xml version="1.0"?><VTKFile type="UnstructuredGrid" byte_order="LittleEndian"><UnstructuredGrid>
<Piece NumberOfPoints="2" NumberOfCells="2"><Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 2 0</DataArray></Points>
<Cells><DataArray type="Int32" Name="connectivity" format="ascii">0 1</DataArray><DataArray type="Int32" Name="offsets" format="ascii">1 2</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">1 1</DataArray></Cells>
<PointData><DataArray type="Float64" Name="radius" format="ascii">%g 0.5</DataArray></PointData></Piece></UnstructuredGrid></VTKFile>"""

# In place of the program: a column that decays at the rate that is set, and a failure for a negative one.
PROGRAM = """#!%s
import json, math, os, sys
settings = dict(a.split("=", 1) for a in sys.argv[2:] if a != "--set")
rate, folder = float(settings.get("A/Rate", 1)), settings["Output/Output folder"]
if rate < 0:
    sys.exit("alluvium: error: the rate is negative.")
os.makedirs(folder, exist_ok=True)
with open(folder + "/statistics.csv", "w") as file:
    file.write("time_s,x\\n" + "".join("%%g,%%.9g\\n" %% (t / 10, math.exp(-rate * t / 10)) for t in range(11)))
with open(folder + "/summary.json", "w") as file:
    json.dump({"ended": "finished"}, file)
with open("count", "a") as file:
    file.write(".")
"""


def write(name: str, text: str) -> None:
    os.makedirs(os.path.dirname(name) or ".", exist_ok=True)
    with open(name, "w") as file:
        file.write(text)


class InTemporaryFolder(unittest.TestCase):
    def setUp(self) -> None:
        self.before = os.getcwd()
        self.temporary = tempfile.TemporaryDirectory()
        os.chdir(self.temporary.name)

    def tearDown(self) -> None:
        os.chdir(self.before)
        self.temporary.cleanup()


class ReadsARun(InTemporaryFolder):
    def setUp(self) -> None:
        super().setUp()
        write("output/statistics.csv", "time_s,head_m,state\n0,0,calm\n0.1,,calm\n0.2,0.4,calm\n0.3,0.")
        write("output/summary.json", json.dumps({"ended": "finished", "timing": {"fluid": {"cpu_s": 2.0}, "contacts": {"cpu_s": 3.0}}}))
        write("output/parameters.prm", "set Method = default\nsubsection Grains\n  set Density = 2630 # kg\n  subsection Deposit: x\n    set Seed = 7\n  end\nend\n")
        write("output/grains.pvd", PVD % "".join('<DataSet timestep="%g" file="g-%d.vtu"/>' % (0.1 * i, i) for i in range(3)))
        for i in range(3):
            write("output/g-%d.vtu" % i, VTU % i)
        self.run_ = alluvium.Run("output")

    def test_columns(self) -> None:
        run = self.run_
        self.assertEqual(list(run.time), [0, 0.1, 0.2])  # the torn row is left out
        self.assertTrue(np.isnan(run.columns["head_m"][1]) and np.isnan(run.columns["state"][0]))
        self.assertEqual(run.last("head_m"), 0.4)
        self.assertAlmostEqual(run.at(0.15, "time_s"), 0.15)
        self.assertTrue(run.has_finished)
        self.assertEqual((run.cpu(), run.cpu("fluid", "no such")), (5.0, 2.0))

    def test_pictures(self) -> None:
        self.assertTrue(np.allclose(self.run_.times(), [0, 0.1, 0.2]))
        self.assertEqual([grains.fields["radius"][0] for _, grains in self.run_.grains()], [0, 1, 2])
        time, grains = self.run_.picture("grains", 0.12)
        self.assertEqual((time, grains.fields["radius"][0], grains.points[1, 1]), (0.1, 1, 2))
        self.assertEqual(self.run_.pictures("fluid"), [])
        with self.assertRaises(FileNotFoundError):
            self.run_.picture("fluid", 0)

    def test_parameters(self) -> None:
        self.assertEqual(self.run_.parameter("Grains/Density"), "2630")
        self.assertEqual(self.run_.parameter("Grains/Deposit: x/Seed"), "7")
        with self.assertRaises(KeyError):
            self.run_.parameter("Density")

    def test_nothing_there(self) -> None:
        run = alluvium.Run("nowhere")
        self.assertEqual((run.columns, run.summary, run.has_finished), ({}, {}, False))


class SweepsAndCompares(InTemporaryFolder):
    def setUp(self) -> None:
        super().setUp()
        write("program", PROGRAM % sys.executable)
        os.chmod("program", os.stat("program").st_mode | stat.S_IXUSR)
        write("scene.prm", "set A = 1\n")

    def sweep(self, rates: list) -> list:
        return alluvium.sweep("scene.prm", {"A/Rate": rates, "A/Other": [True, False]}, "sweep", at_once=2, alluvium=os.path.abspath("program"))

    def count(self) -> int:
        with open("count") as file:
            return len(file.read())

    def test_sweep(self) -> None:
        points = self.sweep([1, 2.5])
        self.assertEqual([point.settings for point in points], [{"A/Rate": r, "A/Other": o} for r in (1, 2.5) for o in (True, False)])
        self.assertAlmostEqual(points[2].run.last("x"), np.exp(-2.5), places=8)
        self.assertEqual(self.count(), 4)
        self.sweep([1, 2.5])
        self.assertEqual(self.count(), 4)  # nothing is run again
        self.sweep([1, 3])
        self.assertEqual(self.count(), 6)
        write("scene.prm", "set A = 2\n")
        self.sweep([1, 3])
        self.assertEqual(self.count(), 10)

    def test_failure(self) -> None:
        point = self.sweep([-1])[0]
        self.assertIsNone(point.run)
        self.assertEqual(point.message, "alluvium: error: the rate is negative.")

    def test_compare(self) -> None:
        first, second = (point.run for point in self.sweep([1, 2])[::2])
        found = alluvium.compare(first, second)
        t = np.arange(11) / 10
        expected = np.abs(np.exp(-t) - np.exp(-2 * t))
        self.assertAlmostEqual(found.largest, expected.max(), places=8)
        self.assertAlmostEqual(found.differences[0].time, t[expected.argmax()])
        self.assertEqual(alluvium.compare(first, first).largest, 0)
        command = [sys.executable, "-c", "import alluvium.comparison; alluvium.comparison.main()", first.folder, second.folder, "--tolerance"]
        environment = dict(os.environ, PYTHONPATH=os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
        for tolerance, code in (("0.1", 1), ("0.5", 0)):
            self.assertEqual(subprocess.run(command + [tolerance], env=environment, stdout=subprocess.DEVNULL).returncode, code)

    def test_compare_other_times(self) -> None:
        write("a/statistics.csv", "time_s,x,only\n0,0,1\n1,1,1\n2,2,1\n")
        write("b/statistics.csv", "time_s,x\n0.5,0.5\n1.5,1.6\n")
        found = alluvium.compare(alluvium.Run("a"), alluvium.Run("b"))
        self.assertEqual((found.from_time, found.to_time, found.only_in_first), (0.5, 1.5, ["only"]))
        self.assertAlmostEqual(found.differences[0].relative, 0.05 / 1.05)
        write("b/statistics.csv", "time_s,x\n5,1\n")
        with self.assertRaises(ValueError):
            alluvium.compare(alluvium.Run("a"), alluvium.Run("b"))


if __name__ == "__main__":
    unittest.main()
