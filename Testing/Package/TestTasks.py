# SPDX-License-Identifier: BSD-3-Clause
"""A script of Documentation/Tasks.md: what the page says of it is so, and its figures are on the page.

TestTasks.py <source folder> <folder of meshes/, points_3/ and images/> <script>
"""
import importlib.util
from pathlib import Path
import re
import subprocess
import sys
import tempfile
import unittest

SOURCE, DATA, SCRIPT = Path(sys.argv.pop(1)), Path(sys.argv.pop(1)), sys.argv.pop(1)
PAGE = SOURCE / "Documentation" / "Tasks.md"
# Figures of the page are those of another processor perhaps.
TOLERANCE = 0.1
LAST_DIGITS = 2  # units of the last digit that is printed

NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
COLUMNS = re.compile(r"\s{2,}")


def run_all():
    spec = importlib.util.spec_from_file_location(
        "run_all", SOURCE / "Examples" / "Python" / "tasks" / "run_all.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def may_differ_by(text):
    digits = len(text.split(".")[1]) if "." in text else 0
    return max(TOLERANCE * abs(float(text)), LAST_DIGITS * 10.0**-digits)


class TestTasks(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scripts = run_all()
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(
                cls.scripts.command(SCRIPT, DATA, Path(folder), picture=False),
                capture_output=True, text=True, check=False)
        cls.output, cls.messages, cls.code = done.stdout, done.stderr, done.returncode
        rows = [COLUMNS.split(line.strip()) for line in done.stdout.splitlines()]
        cls.figures = {row[0]: row[1] for row in rows if len(row) == 2}
        cls.table = {row[0]: row[1:] for row in rows if len(row) > 2}

    def test_ends_without_errors(self):
        self.assertEqual(self.code, 0, self.messages)
        self.assertNotIn("ERR|", self.messages)  # warnings are what some of the data deserve

    def test_figures_are_those_of_the_page(self):
        expected, _, _ = self.scripts.figures_on(PAGE.read_text(encoding="utf-8"), SCRIPT)
        self.assertGreater(len(expected.splitlines()), 5)
        # The columns are as wide as their figures.
        found, wanted = (" ".join(NUMBER.sub("#", text).split())
                         for text in (self.output, expected))
        self.assertEqual(found, wanted)
        for line, wanted in zip(self.output.splitlines(), expected.splitlines()):
            for number, reference in zip(NUMBER.findall(line), NUMBER.findall(wanted)):
                self.assertLessEqual(
                    abs(float(number) - float(reference)), may_differ_by(reference), line)

    def test_what_the_page_says(self):
        getattr(self, "check_" + Path(SCRIPT).stem)()

    def numbers(self, name):
        return [float(number) for number in NUMBER.findall(self.figures[name])]

    def number(self, name):
        return self.numbers(name)[0]

    def is_closed(self, name=""):
        self.assertEqual(self.figures[name + "components"], "1")
        self.assertEqual(self.figures[name + "open edges"], "0")

    def check_terrain(self):
        self.assertEqual(self.figures["components"], "1")
        self.assertEqual(self.figures["precision of the surface"], "double")
        self.assertEqual(self.figures["precision of the contour lines"], "double")
        self.assertLessEqual(self.number("border from the nearest point at most, m"),
                             3 * self.number("point spacing, m"))
        self.assertLess(self.number("of points left out, median and 90 %, m"), 0.05)
        median = self.numbers("all points, FairingWeight 5e-5: median distance, m")[-1]
        self.assertLess(median, 0.03)

    def check_statue(self):
        before, after = self.numbers("scans apart, before and after, mm")
        self.assertLess(after, 0.15 * before)
        mean = {}
        for name in ("as given: ", "registered: ", "Padding 0.15: "):
            self.assertEqual(self.figures[name + "components"], "1")
            mean[name], _ = self.numbers(name + "from the statue, mean and 99 %, mm")[-2:]
        self.assertLess(mean["registered: "], 0.6 * mean["as given: "])
        self.assertGreaterEqual(self.number("registered: parts trimmed"), 1)
        self.assertGreater(self.number("registered: open edges"), 0)
        self.is_closed("Padding 0.15: ")
        self.assertEqual(self.figures["Padding 0.15: parts trimmed"], "0")
        self.assertLess(mean["Padding 0.15: "], 1.8)  # a thousandth of its height

    def check_part(self):
        cut, elsewhere = {}, {}
        for name in ("as it is: ", "twice as fine: ", "4 x points: "):
            self.is_closed(name)
            found, true = self.numbers(name + "genus")
            self.assertEqual(found, true)
            elsewhere[name] = self.number(name + "elsewhere off by, mean and 99 %, mm")
            cut[name] = self.number(name + "sharp edges cut by, mean and max, mm")
        self.assertLess(max(elsewhere.values()), 0.005)
        for name in ("as it is: ", "4 x points: "):  # lattices that suit the points
            self.assertLess(cut[name], 0.3 * self.number(name + "knot spacing, mm"))
        self.assertLess(cut["4 x points: "], 0.6 * cut["as it is: "])
        # A finer lattice alone: the points decide how far edges are rounded.
        self.assertLess(cut["twice as fine: "], cut["as it is: "])
        self.assertGreater(cut["twice as fine: "], 0.6 * cut["as it is: "])
        self.assertLess(elsewhere["twice as fine: "], elsewhere["as it is: "])

    def check_organ(self):
        self.is_closed()
        slices = self.numbers("voxel, mm")[2]
        self.assertLess(self.numbers("distance of the points, mean and 99 %, mm")[1], slices)
        voxels = self.number("volume of the voxels, ml")
        self.assertLess(abs(self.number("volume of the surface, ml") - voxels), 1e-3 * voxels)
        self.assertGreater(self.number("smoothing length, mm"), slices)
        for size in (0, 60):
            self.assertEqual(self.figures[f"one slice, GridSize {size}: curves"], "1")

    def check_photos(self):
        self.is_closed()
        self.assertGreater(self.number("normals on the right side"), 99.9)
        noise = self.number("distance of the points from the truth, rms, mm")
        found = self.number("distance of the surface from the truth, rms, mm")
        self.assertLess(found, noise / 2)
        self.assertLess(found, self.number("without smoothing: distance, rms, mm") / 2)
        self.assertLess(self.number("colours of the surface, rms error"),
                        self.number("colours of the nearest points, rms error") / 5)

    def check_EstimateNormals(self):
        for name in ("kitten.xyz", "bunny00.off", "ball.ply", "refined_elephant.off"):
            row = " ".join(self.table[name]).split()
            self.assertGreater(float(row[1]), 99.5, name)
            self.assertEqual(row[-2:], ["1", "0"], name)


if __name__ == "__main__":
    unittest.main()
