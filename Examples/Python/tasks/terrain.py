#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Terrain: a laser scan from the air in map coordinates, its ground as a surface, contour lines.

    python3 terrain.py --data build/data

The points are points_3/b9_training.ply of Debian's package libcgal-demo: a building and what is
around it. They have no normals.
"""
import sys

from common import (SCALE, add_scale, colour_range, dots, estimated_normals, light, lines, options,
                    points_of, shaded, show, write)
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk

from ipia import vtkIPIASurfaceReconstruction
from ipia_2019.drawing import INK, RED, Sheet, View
from reconstruct import distances, moved, number_of_components, polydata, read

AIRCRAFT = 1000.0  # m above the ground: every point was seen from there
CELL = 25.0  # m, in each of which some of the lowest points are ground
GROUND = 0.9  # m above the plane of the ground
INTERVAL = 0.25  # m between contour lines
HELD_OUT = 20  # every so manieth point is left out of a fit, to measure it
CLEAN_FAIRING = 5e-5  # what the fitter takes where it finds no noise


def is_ground(points):
    """Those at most GROUND above a plane through the lowest points of square cells."""
    across = points[:, :2] - points[:, :2].min(axis=0)
    cells = (across / CELL).astype(int)
    low = np.array([i for cell in np.unique(cells, axis=0)
                    for i in [np.flatnonzero((cells == cell).all(axis=1))]
                    for i in i[np.argsort(points[i, 2])[:max(1, len(i) // 20)]]])
    columns = np.column_stack((across, np.ones(len(points))))
    for _ in range(10):  # leaves out cells that only hold a roof
        plane = np.linalg.lstsq(columns[low], points[low, 2], rcond=None)[0]
        height = points[:, 2] - columns @ plane
        low = low[np.abs(height[low]) < GROUND]
    return height < GROUND


def reconstruction_of(points):
    reconstruction = vtkIPIASurfaceReconstruction()
    above = points.mean(axis=0) + (0, 0, AIRCRAFT)
    reconstruction.SetInputData(polydata(points, estimated_normals(points, above)))
    return reconstruction


def ground_of(points):
    reconstruction = reconstruction_of(points)
    reconstruction.SetHoleSize(0.3)  # fills the place of the building
    return reconstruction


def contour_lines(surface, interval):
    """Lines of equal height, at multiples of the interval."""
    heights = points_of(surface)[:, 2]
    with_height = vtk.vtkPolyData()
    with_height.ShallowCopy(surface)
    array = numpy_to_vtk(heights, deep=True)
    array.SetName("Height")
    with_height.GetPointData().SetScalars(array)
    contour = vtk.vtkContourFilter()
    contour.SetInputData(with_height)
    contour.SetOutputPointsPrecision(vtk.vtkAlgorithm.DOUBLE_PRECISION)
    first, last = np.ceil(heights.min() / interval), np.floor(heights.max() / interval)
    for k, value in enumerate(np.arange(first, last + 1) * interval):
        contour.SetValue(k, value)
    contour.Update()
    return with_height, contour.GetOutput()


def border_overhang(surface, points):
    """How far the border of the surface is from the nearest point, at most."""
    edges = vtk.vtkFeatureEdges()
    edges.SetInputData(surface)
    edges.FeatureEdgesOff()
    edges.NonManifoldEdgesOff()
    edges.Update()
    locator = vtk.vtkKdTreePointLocator()
    locator.SetDataSet(polydata(points))
    locator.BuildLocator()
    border = points_of(edges.GetOutput())
    nearest = points[[locator.FindClosestPoint(x) for x in border]]
    return np.linalg.norm(border - nearest, axis=1).max()


def main():
    given = options(__doc__.splitlines()[0])
    everything = points_of(read(str(given.data / "points_3" / "b9_training.ply")))
    ground = everything[is_ground(everything)]
    show("points", len(everything))
    show("easting, northing of the first, m", *(f"{v:.3f}" for v in everything[0, :2]))
    show("ground points", len(ground))

    reconstruction = ground_of(ground)
    reconstruction.Update()
    terrain, fitter = reconstruction.GetOutput(), reconstruction.GetFitter()
    show("precision of the surface", terrain.GetPoints().GetData().GetDataTypeAsString())
    show("components", number_of_components(terrain))
    show("parts trimmed", reconstruction.GetNumberOfPartsTrimmed())
    spacing = np.diff(fitter.GetModelBoundsUsed()[:2])[0] / (fitter.GetGridSizeUsed()[0] - 3) / 0.85
    show("point spacing, m", f"{spacing:.2f}")
    show("border from the nearest point at most, m", f"{border_overhang(terrain, ground):.2f}")
    apart = distances(ground, terrain)
    show("distance of the points, median and 90 %, m",
         *(f"{v:.3f}" for v in np.percentile(apart, (50, 90))))
    held_out = np.arange(len(ground)) % HELD_OUT == HELD_OUT // 2
    check = ground_of(ground[~held_out])
    check.Update()
    apart = distances(ground[held_out], check.GetOutput())
    show("of points left out, median and 90 %, m",
         *(f"{v:.3f}" for v in np.percentile(apart, (50, 90))))
    with_height, contours = contour_lines(terrain, INTERVAL)
    show("height of the terrain, m", *(f"{v:.2f}" for v in terrain.GetBounds()[4:]))
    show("precision of the contour lines", contours.GetPoints().GetData().GetDataTypeAsString())

    roofs = reconstruction_of(everything)
    roofs.GetFitter().SetFairingWeight(CLEAN_FAIRING)
    roofs.Update()
    show("all points, FairingWeight 5e-5: median distance, m",
         f"{np.median(distances(everything, roofs.GetOutput())):.3f}")

    write(terrain, given.output / "terrain.vtp")
    if not given.no_picture:
        centre = ground.mean(axis=0)  # so does the graphics card
        low = moved(with_height, -centre)
        seen = View(direction=(-0.45, -1, 1.1), up=(0, 0, 1))
        sheet = Sheet(1, 3, (340, 290), SCALE)
        is_low = is_ground(everything)
        sheet.tile(0, 0, "the scan: ground (blue) and the rest",
                   [dots(polydata(ground - centre), size=1),
                    dots(polydata(everything[~is_low] - centre), RED, 1)], seen)
        heights = colour_range(*np.percentile(points_of(terrain)[:, 2], (0.5, 99.5)),
                               ((0.36, 0.55, 0.36), (0.86, 0.83, 0.58), (0.72, 0.50, 0.33)))
        relief = shaded(low)
        relief.GetMapper().SetLookupTable(heights)
        tile = sheet.tile(0, 1, f"terrain: height in m, lines every {INTERVAL} m",
                          [relief, lines(moved(contours, -centre), INK, 0.6)], seen)
        light(tile)
        add_scale(tile, heights, "%.1f")
        light(sheet.tile(0, 2, "all points, FairingWeight 5e-5",
                         [shaded(moved(roofs.GetOutput(), -centre))], seen))
        sheet.write(given.output / "task-terrain.png")
    return 0


if __name__ == "__main__":
    sys.exit(main())
