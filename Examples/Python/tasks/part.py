#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A machine part with sharp edges: how far they are rounded, and what resolution does about it.

    python3 part.py --data build/data

Points are spread over the faces of anchor.off of Debian's package libcgal-demo, with the normals
of these faces. So the true surface is known.
"""
import sys

from common import (SCALE, add_scale, colour_range, light, options, points_of, shaded, show, write)
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

from ipia import vtkIPIASurfaceReconstruction
from ipia_2019.drawing import Sheet, View
from ipia_2019.meshes import mesh_polydata
from reconstruct import distances, number_of_components, number_of_open_edges, polydata

LENGTH = 100.0  # mm, the longest side
POINTS = 30_000
SHARP = 40.0  # degrees between the faces beside a sharp edge
VARIANTS = (("as it is", 1, 1), ("twice as fine", 1, 2), ("4 x points", 4, 1))  # points, GridSize
STEP = 0.5  # mm between the places where the rounding of edges is measured
SEED = 1


def part_of(mesh):
    points = points_of(mesh)
    scaled = vtk.vtkPolyData()
    scaled.DeepCopy(mesh)
    corners = LENGTH / np.ptp(points, axis=0).max() * (points - points.min(axis=0))
    scaled.GetPoints().SetData(numpy_to_vtk(corners, deep=True))
    return scaled


def spread(part, count, random):
    """Points evenly by area on the faces, with the faces' normals."""
    triangles = vtk_to_numpy(part.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    a, b, c = (points_of(part)[triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    areas = np.linalg.norm(normals, axis=1)
    steps = (np.arange(count) + random.random(count)) / count * areas.sum()
    k = np.searchsorted(np.cumsum(areas), steps).clip(max=len(areas) - 1)
    root, share = np.sqrt(random.random((count, 1))), random.random((count, 1))
    points = (1 - root) * a[k] + root * (1 - share) * b[k] + root * share * c[k]
    return polydata(points, normals[k] / areas[k, None])


def genus(surface):
    """Of a closed surface of one component, from Euler's formula: 3 edges to 2 triangles."""
    return 1 - (surface.GetNumberOfPoints() - surface.GetNumberOfPolys() / 2) / 2


def sharp_edges(part):
    """Points along its sharp edges, STEP apart."""
    edges = vtk.vtkFeatureEdges()
    edges.SetInputData(part)
    edges.SetFeatureAngle(SHARP)
    edges.BoundaryEdgesOff()
    edges.NonManifoldEdgesOff()
    edges.Update()
    ends = points_of(edges.GetOutput())
    lines = vtk_to_numpy(edges.GetOutput().GetLines().GetConnectivityArray()).reshape(-1, 2)
    places = []
    for first, last in zip(ends[lines[:, 0]], ends[lines[:, 1]]):
        count = int(np.ceil(np.linalg.norm(last - first) / STEP)) + 1
        places.append(first + np.linspace(0, 1, count)[:, None] * (last - first))
    return np.vstack(places)


def far_from(points, others, distance):
    """Which points have none of the others within a distance."""
    locator = vtk.vtkStaticPointLocator()
    locator.SetDataSet(polydata(others))
    locator.BuildLocator()
    closest = vtk.reference(0.0)
    return np.array([locator.FindClosestPointWithinRadius(distance, x, closest) < 0
                     for x in points])


def with_distance(surface, part):
    """The surface with the distance of each vertex to the part as its active scalars."""
    array = numpy_to_vtk(distances(points_of(surface), part), deep=True)
    array.SetName("Distance")
    result = vtk.vtkPolyData()
    result.ShallowCopy(surface)
    result.GetPointData().SetScalars(array)
    return result


def main():
    given = options(__doc__.splitlines()[0])
    part = part_of(mesh_polydata(given.data / "meshes" / "anchor.off"))
    edges = sharp_edges(part)
    made = []
    for name, density, fineness in VARIANTS:
        points = spread(part, density * POINTS, np.random.default_rng(SEED))
        reconstruction = vtkIPIASurfaceReconstruction()
        reconstruction.SetInputData(points)
        fitter = reconstruction.GetFitter()
        reconstruction.Update()
        if fineness > 1:
            size = np.array(fitter.GetGridSizeUsed())
            axis = int(np.argmax(size))  # the other axes follow
            fitter.SetGridSize(*(fineness * (size[axis] - 3) + 3 if k == axis else 0
                                 for k in range(3)))
            reconstruction.Update()
        surface = reconstruction.GetOutput()
        bounds, size = fitter.GetModelBoundsUsed(), fitter.GetGridSizeUsed()
        spacing = (bounds[1] - bounds[0]) / (size[0] - 3)
        show(name + ": points", points.GetNumberOfPoints())
        show(name + ": GridSize", *size)
        show(name + ": knot spacing, mm", f"{spacing:.3f}")
        show(name + ": smoothing length, mm", f"{fitter.GetSmoothingLengthUsed():.2f}")
        show(name + ": components", number_of_components(surface))
        show(name + ": genus", f"{genus(surface):g} (the part {genus(part):g})")
        show(name + ": open edges", number_of_open_edges(surface))
        at_edges = distances(edges, surface)
        show(name + ": sharp edges cut by, mean and max, mm",
             f"{at_edges.mean():.3f}", f"{at_edges.max():.3f}")
        surface = with_distance(surface, part)
        apart = vtk_to_numpy(surface.GetPointData().GetScalars())
        flat = far_from(points_of(surface), edges, 3 * spacing)
        show(name + ": elsewhere off by, mean and 99 %, mm",
             *(f"{v:.4f}" for v in (apart[flat].mean(), np.percentile(apart[flat], 99))))
        made.append((f"{name}: knot spacing {spacing:.2f} mm", surface))
    write(made[0][1], given.output / "part.vtp")
    if not given.no_picture:
        seen = View(direction=(0.5, 0.5, 1), up=(0, 1, 0))
        sheet = Sheet(1, 3, (333, 340), SCALE)
        colours = colour_range(0, 0.4, ((0.90, 0.88, 0.82), (0.95, 0.70, 0.35), (0.75, 0.15, 0.15)))
        for column, (title, surface) in enumerate(made):
            actor = shaded(surface)
            actor.GetMapper().SetLookupTable(colours)
            tile = sheet.tile(0, column, title, [actor], seen)
            light(tile)
            if column == 0:
                add_scale(tile, colours, "%.1f")
        sheet.write(given.output / "task-part.png")
    return 0


if __name__ == "__main__":
    sys.exit(main())
