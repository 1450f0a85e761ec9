#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Statue: ten scans from around, each a block of points with the normals of its own view.

    python3 statue.py --data build/data

A scanner is simulated: rays from ten places to a mesh (the armadillo of Debian's package
libcgal-demo, as a statue of 1.8 m), with noise, and each scan a little out of place. So the true
surface is known.
"""
import sys

from common import SCALE, dots, estimated_normals, light, options, points_of, shaded, show, write
import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

from ipia import vtkIPIASurfaceReconstruction
from ipia_2019.drawing import Sheet, View
from ipia_2019.meshes import mesh_polydata
from reconstruct import distances, number_of_components, number_of_open_edges, polydata

HEIGHT = 1.8  # m
AWAY = 3.0  # m from the statue's middle to the scanner
STEPS = 170  # rays across and up
NOISE = 0.0005  # m along the ray, standard deviation
TURNED, SHIFTED = 0.15, 0.002  # degrees, m: how far scans are out of place, standard deviations
GRAZING = 0.15  # cosine of the angle below which nothing comes back
SEED = 1
COLOURS = ((0.84, 0.37, 0.30), (0.27, 0.46, 0.71), (0.45, 0.68, 0.38), (0.93, 0.68, 0.29),
           (0.56, 0.42, 0.67), (0.36, 0.70, 0.71), (0.79, 0.46, 0.60), (0.55, 0.47, 0.36),
           (0.40, 0.40, 0.44), (0.70, 0.72, 0.33))


def statue_of(mesh):
    """The mesh standing on z = 0, HEIGHT high, with normals of its faces."""
    turn = vtk.vtkTransform()
    turn.RotateX(90)
    upright = vtk.vtkTransformPolyDataFilter()
    upright.SetTransform(turn)
    upright.SetInputData(mesh)
    upright.Update()
    bounds = np.array(upright.GetOutput().GetBounds()).reshape(3, 2)
    scale = HEIGHT / (bounds[2, 1] - bounds[2, 0])
    place = vtk.vtkTransform()
    place.Scale(scale, scale, scale)
    place.Translate(*-bounds[:2].mean(axis=1), -bounds[2, 0])
    placed = vtk.vtkTransformPolyDataFilter()
    placed.SetTransform(place)
    placed.SetInputConnection(upright.GetOutputPort())
    normals = vtk.vtkPolyDataNormals()
    normals.SetInputConnection(placed.GetOutputPort())
    normals.ComputePointNormalsOff()
    normals.ComputeCellNormalsOn()
    normals.ConsistencyOff()
    normals.Update()
    return normals.GetOutput()


def scanner_places():
    """Eight around, two from above; none sees the soles."""
    around = np.radians(45 * np.arange(8) + 20)
    middle = np.array((0, 0, HEIGHT / 2))
    sides = np.column_stack((np.cos(around), np.sin(around), np.zeros(8)))
    above = np.array(((0.55, 0.3, 0.8), (-0.55, -0.3, 0.8)))
    return [middle + AWAY * d / np.linalg.norm(d) for d in np.vstack((sides, above))]


def scan(statue, locator, place, random):
    """Points that the rays of a scanner hit first, with normals from their neighbours in it."""
    face_normals = vtk_to_numpy(statue.GetCellData().GetNormals())
    middle = np.array((0, 0, HEIGHT / 2))
    forward = (middle - place) / AWAY
    right = np.cross(forward, (0, 0, 1))
    right /= np.linalg.norm(right)
    upward = np.cross(right, forward)
    t, part, cell = vtk.reference(0.0), vtk.reference(0), vtk.reference(0)
    hit, within = [0.0] * 3, [0.0] * 3
    found = []
    for across in np.linspace(-0.4, 0.4, STEPS):
        for up in np.linspace(-0.4, 0.4, STEPS):
            ray = forward + across * right + up * upward
            ray /= np.linalg.norm(ray)
            if not locator.IntersectWithLine(place, place + 2 * AWAY * ray, 0.0, t, hit, within,
                                             part, cell):
                continue
            if -face_normals[cell.get()] @ ray > GRAZING:
                found.append(hit + random.normal(0, NOISE) * ray)
    points = np.array(found)
    return out_of_place(polydata(points, estimated_normals(points, place)), random)


def out_of_place(scan_in_place, random):
    """A scan as its registration left it: turned about the statue's middle, and shifted."""
    motion = vtk.vtkTransform()
    motion.Translate(*random.normal(0, SHIFTED, 3))
    motion.Translate(0, 0, HEIGHT / 2)
    for turn in (motion.RotateX, motion.RotateY, motion.RotateZ):
        turn(random.normal(0, TURNED))
    motion.Translate(0, 0, -HEIGHT / 2)
    moved = vtk.vtkTransformPolyDataFilter()
    moved.SetTransform(motion)
    moved.SetInputData(scan_in_place)
    moved.Update()
    return moved.GetOutput()


def share_near(points, others, distance):
    """The share of points that have one of the others within a distance."""
    locator = vtk.vtkStaticPointLocator()
    locator.SetDataSet(polydata(others))
    locator.BuildLocator()
    closest = vtk.reference(0.0)
    return np.mean([locator.FindClosestPointWithinRadius(distance, x, closest) >= 0
                    for x in points])


def main():
    given = options(__doc__.splitlines()[0])
    statue = statue_of(mesh_polydata(given.data / "meshes" / "armadillo.off"))
    locator = vtk.vtkStaticCellLocator()
    locator.SetDataSet(statue)
    locator.BuildLocator()
    random = np.random.default_rng(SEED)
    scans = vtk.vtkMultiBlockDataSet()
    for k, place in enumerate(scanner_places()):
        scans.SetBlock(k, scan(statue, locator, place, random))
    blocks = [scans.GetBlock(k) for k in range(scans.GetNumberOfBlocks())]
    points = np.vstack([points_of(block) for block in blocks])
    show("scans", len(blocks))
    show("points", len(points))
    corners = points_of(statue)
    show("of the statue not seen (nothing in 1 cm)",
         f"{100 * (1 - share_near(corners, points, 0.01)):.1f} %")

    reconstruction = vtkIPIASurfaceReconstruction()
    reconstruction.SetInputDataObject(scans)
    made = []
    for name, register, padding in (("as given", False, 0.05), ("registered", True, 0.05),
                                    ("Padding 0.15", True, 0.15)):
        reconstruction.SetRegisterScans(register)
        reconstruction.GetFitter().SetPadding(padding)
        reconstruction.Update()
        surface = vtk.vtkPolyData()
        surface.DeepCopy(reconstruction.GetOutput())
        made.append(surface)
        if register and padding == 0.05:
            registration = reconstruction.GetRegistration()
            show("scans apart, before and after, mm",
                 *(f"{1000 * v:.2f}" for v in (registration.GetMisfitBefore(),
                                               registration.GetMisfitAfter())))
        show(name + ": components", number_of_components(surface))
        show(name + ": parts trimmed", reconstruction.GetNumberOfPartsTrimmed())
        show(name + ": components left out", reconstruction.GetNumberOfComponentsLeftOut())
        show(name + ": open edges", number_of_open_edges(surface))
        show(name + ": noise found, mm",
             f"{1000 * reconstruction.GetFitter().GetNoiseFound():.2f}")
        apart = 1000 * distances(corners, surface)
        show(name + ": from the statue, mean and 99 %, mm",
             *(f"{v:.2f}" for v in (apart.mean(), np.percentile(apart, 99))))
    write(surface, given.output / "statue.vtp")
    if not given.no_picture:
        front = View(direction=(-0.25, 1, 0.12), up=(0, 0, 1))
        below = View(direction=(-0.3, 1, -0.9), up=(0, 0, 1))
        sheet = Sheet(1, 5, (220, 300), SCALE)
        place = np.array(front.direction)
        facing = [polydata(points_of(block)[normals @ place > 0]) for block in blocks
                  for normals in
                  [vtk_to_numpy(block.GetPointData().GetNormals())]]
        sheet.tile(0, 0, "ten scans", [dots(part, colour, 1.6) for part, colour in
                                       zip(facing, COLOURS)], front)
        given_places, low, high = made
        light(sheet.tile(0, 1, "RegisterScans off", [shaded(given_places)], front))
        light(sheet.tile(0, 2, "nothing set", [shaded(low)], front))
        light(sheet.tile(0, 3, "from below", [shaded(low)], below))
        light(sheet.tile(0, 4, "Padding 0.15", [shaded(high)], below))
        sheet.write(given.output / "task-statue.png")
    return 0


if __name__ == "__main__":
    sys.exit(main())
