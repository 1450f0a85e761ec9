#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Scans of a torus, added to a fit one by one, against a fit of all of them each time.

Processor seconds are those of the whole reconstruction: the contour takes most of them here, as it is
made anew each time.

    python3 AddScans.py [surface.vtp]
"""
import random
import sys
import time
from math import cos, pi, sin, sqrt

from ipia import vtkIPIASurfaceReconstruction
from vtkmodules.vtkCommonCore import vtkFloatArray, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet, vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

RING_RADIUS, TUBE_RADIUS = 1.0, 0.4
SCANS, POINTS_OF_SCAN = 10, 4000
CELLS = 96  # along each axis
HALF_SIDE = 1.6


def is_inside(x, y, z):
    """Whether a point is in the torus, but for its outermost layer."""
    return (sqrt(x * x + y * y) - RING_RADIUS)**2 + z * z < TUBE_RADIUS**2 - 1e-3


def make_scan(number):
    """What is seen of the torus from one of ten directions, with normals."""
    rng = random.Random(number)
    z, angle = 1 - 2 * (number + 0.5) / SCANS, 2.39996 * number
    towards = sqrt(1 - z * z) * cos(angle), sqrt(1 - z * z) * sin(angle), z
    points = vtkPoints()
    normals = vtkFloatArray()
    normals.SetNumberOfComponents(3)
    while points.GetNumberOfPoints() < POINTS_OF_SCAN:
        u, v = rng.uniform(0, 2 * pi), rng.uniform(0, 2 * pi)
        normal = cos(u) * cos(v), sin(u) * cos(v), sin(v)
        if sum(n * t for n, t in zip(normal, towards)) < 0.25:
            continue
        centre = RING_RADIUS * cos(u), RING_RADIUS * sin(u), 0
        at = [c + TUBE_RADIUS * n for c, n in zip(centre, normal)]
        if any(is_inside(*(a + 0.06 * k * t for a, t in zip(at, towards))) for k in range(1, 45)):
            continue
        points.InsertNextPoint(at)
        normals.InsertNextTuple(normal)
    scan = vtkPolyData()
    scan.SetPoints(points)
    scan.GetPointData().SetNormals(normals)
    return scan


def make_reconstruction(incremental):
    """On a given lattice, as that of the points would change from scan to scan."""
    reconstruction = vtkIPIASurfaceReconstruction()
    fitter = reconstruction.GetFitter()
    fitter.SetIncremental(incremental)
    fitter.SetModelBounds(*(3 * (-HALF_SIDE, HALF_SIDE)))
    fitter.SetGridSize(*(3 * (CELLS + 3, )))
    return reconstruction


def seconds_of(reconstruction, scans):
    """Processor time to bring a reconstruction up to date with the scans."""
    data = vtkMultiBlockDataSet()
    for k, scan in enumerate(scans):
        data.SetBlock(k, scan)
    reconstruction.SetInputDataObject(data)
    start = time.process_time()
    reconstruction.Update()
    return time.process_time() - start


def difference(first, second, scans):
    """Root mean square of the difference at the points and beside them, by the longest side."""
    f, g = (r.GetFitter().GetImplicitFunction() for r in (first, second))
    spacing = 2 * HALF_SIDE / CELLS
    total = count = 0
    for scan in scans:
        for k in range(0, scan.GetNumberOfPoints(), 10):
            point, normal = scan.GetPoint(k), scan.GetPointData().GetNormals().GetTuple(k)
            for step in (-2, -1, 0, 1, 2):
                x = [p + step * spacing * n for p, n in zip(point, normal)]
                total += (f.FunctionValue(x) - g.FunctionValue(x))**2
                count += 1
    return sqrt(total / count) / (2 * HALF_SIDE)


scans = [make_scan(k) for k in range(SCANS)]
growing = make_reconstruction(True)
print("scans  points added  coefficients solved, of all   s     s, all  difference")
for count in range(1, SCANS + 1):
    seconds = seconds_of(growing, scans[:count])
    anew = make_reconstruction(False)
    all_seconds = seconds_of(anew, scans[:count])
    fitter = growing.GetFitter()
    share = fitter.GetNumberOfCoefficientsSolved() / anew.GetFitter().GetNumberOfCoefficientsSolved()
    apart = difference(growing, anew, scans[:count])
    print(f"{count:5d} {fitter.GetNumberOfPointsAdded():13d} "
          f"{fitter.GetNumberOfCoefficientsSolved():20d} {share:8.0%} {seconds:6.2f} "
          f"{all_seconds:7.2f} {apart:11.1e}")

writer = vtkXMLPolyDataWriter()
writer.SetInputConnection(growing.GetOutputPort())
writer.SetFileName(sys.argv[1] if len(sys.argv) > 1 else "scans.vtp")
sys.exit(0 if writer.Write() and share < 1 / 3 and apart < 1e-3 else 1)
