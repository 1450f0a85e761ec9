# SPDX-License-Identifier: BSD-3-Clause
"""Examples/Python/reconstruct.py as users run it: file formats, results, mistakes.

TestReconstruct.py <path of reconstruct.py>
"""
import importlib.util
import os
import re
import subprocess
import sys
import tempfile
import unittest

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkIOGeometry import vtkOBJWriter
from vtkmodules.vtkIOImage import vtkPNGReader
from vtkmodules.vtkIOPLY import vtkPLYReader, vtkPLYWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLPolyDataReader, vtkXMLPolyDataWriter
from vtkmodules.vtkFiltersCore import vtkMassProperties
from vtkmodules.vtkFiltersSources import vtkSphereSource

SCRIPT = sys.argv.pop(1) if len(sys.argv) > 1 else ""
RADIUS = 2.0


def sphere(count=1500):
    """Points spread evenly over a sphere (a Fibonacci lattice), with outward normals."""
    z = 1 - (2 * np.arange(count) + 1) / count
    angle = np.pi * (1 + 5**0.5) * np.arange(count)
    across = np.sqrt(1 - z * z)
    normals = np.stack((across * np.cos(angle), across * np.sin(angle), z), axis=1)
    return RADIUS * normals, normals


def load_script():
    spec = importlib.util.spec_from_file_location("reconstruct", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class TestReconstruct(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.script = load_script()
        self.points, self.normals = sphere()

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def file(self, name, *blocks, count=None, delimiter=" "):
        """A text file of one or more tables, after the count."""
        with open(self.path(name), "w", encoding="utf-8") as file:
            if count is not None:
                print(count, file=file)
            for block in blocks:
                np.savetxt(file, block, fmt="%.9g", delimiter=delimiter)
        return self.path(name)

    def run_script(self, path, *options):
        return subprocess.run(
            [sys.executable, SCRIPT, path, "--output", self.path("out"), *options],
            capture_output=True,
            text=True,
            check=False,
        )

    def surface(self):
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(self.path("out/surface.vtp"))
        reader.Update()
        return reader.GetOutput()

    def volume(self):
        """Of surface.vtp; positive where triangles face outward."""
        surface = self.surface()
        x = vtk_to_numpy(surface.GetPoints().GetData())
        x = x - x.mean(axis=0)
        corners = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        a, b, c = (x[corners[:, i]] for i in range(3))
        return np.sum(a * np.cross(b, c)) / 6

    def assert_is_sphere(self):
        self.assertAlmostEqual(self.volume() / (4 / 3 * np.pi * RADIUS**3), 1, delta=0.01)

    def assert_reads(self, path, with_normals):
        data = self.script.read(path)
        points = vtk_to_numpy(data.GetPoints().GetData())
        np.testing.assert_allclose(points, self.points, atol=1e-6)
        if with_normals:
            normals = vtk_to_numpy(data.GetPointData().GetNormals())
            np.testing.assert_allclose(normals, self.normals, atol=1e-6)
        else:
            self.assertIsNone(data.GetPointData().GetNormals())

    def test_colours_of_text_files_are_read(self):
        rgb = np.tile([[10, 20, 250]], (len(self.points), 1))
        intensity = np.ones((len(self.points), 1))
        for columns in ((rgb,), (intensity, rgb), (self.normals, rgb), (self.normals, rgb, intensity)):
            data = self.script.read(self.file("points.xyz", np.hstack((self.points, *columns))))
            self.assertEqual(data.GetPointData().GetArray("RGB").GetTuple(7), (10, 20, 250))
            self.assertEqual(data.GetPointData().GetNormals() is None, columns[0] is not self.normals)
        data = self.script.read(self.file("plain.xyz", np.hstack((self.points, self.normals))))
        self.assertIsNone(data.GetPointData().GetArray("RGB"))

    def test_colours_of_a_ply_file_are_in_the_results(self):
        data = self.script.polydata(self.points, self.normals)
        red = np.where(self.points[:, :1] > 0, 250, 20)
        rgb = np.hstack((red, np.full_like(red, 60), 255 - red)).astype(np.uint8)
        array = numpy_to_vtk(rgb, deep=True)
        array.SetName("RGB")
        data.GetPointData().SetScalars(array)
        writer = vtkPLYWriter()
        writer.SetFileName(self.path("coloured.ply"))
        writer.SetInputData(data)
        writer.SetArrayName("RGB")
        writer.Write()
        done = self.run_script(self.path("coloured.ply"), "--no-picture")
        self.assertEqual(done.returncode, 0, done.stderr)
        reader = vtkPLYReader()
        reader.SetFileName(self.path("out/surface.ply"))
        reader.Update()
        for surface in (self.surface(), reader.GetOutput()):
            x = vtk_to_numpy(surface.GetPoints().GetData())[:, 0]
            found = vtk_to_numpy(surface.GetPointData().GetArray("RGB")).astype(int)
            self.assertTrue(np.all(found[x > 0.3 * RADIUS] >= [200, 59, 0]))
            self.assertTrue(np.all(found[x < -0.3 * RADIUS] <= [70, 61, 255]))

    def test_all_results_are_written(self):
        path = self.file("sphere.xyz", np.hstack((self.points, self.normals)))
        result = self.run_script(path)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assert_is_sphere()
        self.assertIn("1,500 points; normals as given", result.stdout)
        self.assertIn("closed, 1 component\n", result.stdout)
        image = vtkXMLImageDataReader()
        image.SetFileName(self.path("out/f.vti"))
        image.Update()
        f = vtk_to_numpy(image.GetOutput().GetPointData().GetArray("f"))
        self.assertLess(f.min(), 0)
        self.assertGreater(f[0], 0)
        # f.vti is signed distance near the sphere, at its own samples.
        samples = image.GetOutput()
        distances = np.linalg.norm([samples.GetPoint(i) for i in range(len(f))], axis=1) - RADIUS
        near = np.abs(distances) < 0.05
        self.assertGreater(near.sum(), 100)
        np.testing.assert_allclose(f[near], distances[near], atol=0.005)
        ply = vtkPLYReader()
        ply.SetFileName(self.path("out/surface.ply"))
        ply.Update()
        size = vtkMassProperties()
        size.SetInputConnection(ply.GetOutputPort())
        self.assertAlmostEqual(size.GetVolume() / self.volume(), 1, delta=1e-5)
        picture = vtkPNGReader()
        picture.SetFileName(self.path("out/picture.png"))
        picture.Update()
        pixels = vtk_to_numpy(picture.GetOutput().GetPointData().GetScalars()).astype(int)
        # The surface is drawn in a warm colour, on the right of a bluish background.
        columns = pixels.reshape(800, 1600, 3)[300:500]
        warm = columns[:, :, 0] > columns[:, :, 2] + 30
        self.assertGreater(warm[:, 1150:1250].mean(), 0.99)
        self.assertEqual(warm[:, :800].mean(), 0)

    def test_curves_across_every_axis(self):
        angle = 2 * np.pi * np.arange(300) / 300
        circle = np.stack((np.cos(angle), np.sin(angle)), axis=1)
        for across in range(3):
            with self.subTest(across):
                normals = np.insert(circle, across, 0, axis=1)
                points = np.insert(RADIUS * circle, across, 5, axis=1)
                path = self.file("curve.xyz", np.hstack((points, normals)))
                result = self.run_script(path, "--no-picture")
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertIn("points, 1 component\n", result.stdout)
                curve = vtk_to_numpy(self.surface().GetPoints().GetData())
                np.testing.assert_allclose(curve[:, across], 5, atol=1e-6)
                radii = np.linalg.norm(np.delete(curve, across, axis=1), axis=1)
                np.testing.assert_allclose(radii, RADIUS, rtol=1e-4)

    def test_noise_is_told(self):
        points, normals = sphere(8000)
        random = np.random.default_rng(1)
        points = points + random.normal(0, 0.02, points.shape)
        path = self.file("noisy.xyz", np.hstack((points, normals)))
        result = self.run_script(path, "--no-picture")
        self.assertEqual(result.returncode, 0, result.stderr)
        noise = re.search(r"noise of (\S+) found, smoothed below a length of \S+", result.stdout)
        self.assertIsNotNone(noise, result.stdout)
        self.assertAlmostEqual(float(noise[1]), 0.02, delta=0.004)
        self.assert_is_sphere()

    def test_distances_are_those_of_the_points(self):
        surface = vtkSphereSource()
        surface.SetRadius(RADIUS)
        surface.SetThetaResolution(200)
        surface.SetPhiResolution(200)
        surface.Update()
        for factor in (0.9, 1.2):
            values = self.script.distances(factor * self.points, surface.GetOutput())
            np.testing.assert_allclose(values, abs(factor - 1) * RADIUS, atol=1e-3)

    def test_six_columns(self):
        table = np.hstack((self.points, self.normals))
        self.assert_reads(self.file("a.xyz", table), True)
        self.assert_reads(self.file("a.pwn", table, count=len(table)), True)
        self.assert_reads(self.file("a.pts", table, delimiter=","), True)

    def test_points_then_normals(self):
        count = len(self.points)
        self.assert_reads(self.file("a.pwn", self.points, self.normals, count=count), True)

    def test_colours_are_no_normals(self):
        colours = np.arange(3 * len(self.points)).reshape(-1, 3) % 256
        intensity = np.full((len(self.points), 1), 0.5)
        self.assert_reads(self.file("a.xyz", np.hstack((self.points, colours))), False)
        count = len(self.points)
        table = np.hstack((self.points, intensity, colours))
        self.assert_reads(self.file("a.pts", table, count=count), False)
        table = np.hstack((self.points, self.normals, colours))
        self.assert_reads(self.file("b.xyz", table), True)

    def test_points_without_normals(self):
        result = self.run_script(self.file("a.xyz", self.points), "--no-picture")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("estimated", result.stdout)
        self.assert_is_sphere()
        self.assertFalse(os.path.exists(self.path("out/picture.png")))

    def test_faces_give_normals(self):
        source = vtkSphereSource()
        source.SetRadius(RADIUS)
        source.SetThetaResolution(60)
        source.SetPhiResolution(60)
        source.GenerateNormalsOff()
        for name, writer in (("a.ply", vtkPLYWriter()), ("a.obj", vtkOBJWriter())):
            writer.SetInputConnection(source.GetOutputPort())
            writer.SetFileName(self.path(name))
            writer.Write()
            result = self.run_script(self.path(name), "--no-picture")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("of the faces", result.stdout)
            self.assert_is_sphere()

    def test_vtp_far_from_the_origin(self):
        shift = np.array((5e6, 4e5, 100))
        writer = vtkXMLPolyDataWriter()
        writer.SetInputData(self.script.polydata(self.points + shift, self.normals))
        writer.SetFileName(self.path("a.vtp"))
        writer.Write()
        result = self.run_script(self.path("a.vtp"), "--no-picture")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assert_is_sphere()

    def assert_refused(self, path, words):
        result = self.run_script(path, "--no-picture")
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        self.assertIn(words, result.stderr)
        self.assertFalse(os.path.exists(self.path("out")))

    def test_mistakes_give_one_line(self):
        text = {
            "a.foo": ("", "suffix"),
            "empty.xyz": ("", "no points"),
            "empty.ply": ("", "does not begin with 'ply'"),
            "cut.ply": ("ply\nformat ascii 1.0\nelement vertex 9\nproperty float x\nproperty "
                        "float y\nproperty float z\nend_header\n1 2 3\n", "cannot be read"),
            "cut.vtp": ("<VTKFile type='PolyData'>", "cannot be read"),
            "none.obj": ("# nothing\n", "no points"),
            "words.xyz": ("a b c\n", "not a table of numbers"),
            "two.xyz": ("1 2\n", "2 columns"),
            "ragged.xyz": ("1 2 3\n4 5\n", "different numbers of columns"),
            "count.pts": ("3\n1 2 3\n4 5 6\n", "announces 3 points"),
            "equal.xyz": ("1 2 3\n" * 5, "equal"),
        }
        for name, (content, words) in text.items():
            with self.subTest(name):
                with open(self.path(name), "w", encoding="utf-8") as file:
                    file.write(content)
                self.assert_refused(self.path(name), words)
        self.assert_refused(self.path("missing.ply"), "No such file")


if __name__ == "__main__":
    unittest.main()
