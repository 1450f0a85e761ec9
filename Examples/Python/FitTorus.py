#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Oriented points on a torus -> surface; as Examples/Cxx/FitTorus.cxx.

    python3 FitTorus.py [surface.vtp]
"""
import sys
from math import cos, pi, sin

from ipia import vtkIPIASurfaceReconstruction
from vtkmodules.vtkCommonCore import vtkFloatArray, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersCore import vtkMassProperties
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

RING_RADIUS, TUBE_RADIUS = 1.0, 0.4


def make_torus(around=120, across=48):
    """Points on a torus around the z axis, with their outward normals."""
    points = vtkPoints()
    normals = vtkFloatArray()
    normals.SetName("Normals")
    normals.SetNumberOfComponents(3)
    for i in range(around):
        for j in range(across):
            u, v = 2 * pi * i / around, 2 * pi * j / across
            normal = cos(u) * cos(v), sin(u) * cos(v), sin(v)
            centre = RING_RADIUS * cos(u), RING_RADIUS * sin(u), 0
            points.InsertNextPoint([c + TUBE_RADIUS * n for c, n in zip(centre, normal)])
            normals.InsertNextTuple(normal)
    torus = vtkPolyData()
    torus.SetPoints(points)
    torus.GetPointData().SetNormals(normals)
    return torus


torus = make_torus()

reconstruction = vtkIPIASurfaceReconstruction()
reconstruction.SetInputData(torus)
size = vtkMassProperties()
size.SetInputConnection(reconstruction.GetOutputPort())
size.Update()

fitter = reconstruction.GetFitter()
exact = 2 * (pi * TUBE_RADIUS) ** 2 * RING_RADIUS
lattice = " x ".join(str(n) for n in fitter.GetGridSizeUsed())
print(f"{torus.GetNumberOfPoints()} points, {lattice} coefficients")
print(f"max |f| at the points: {fitter.GetMaximumError():.6g}")
print(f"volume: {size.GetVolume():.6g} (exact: {exact:.6g})")

writer = vtkXMLPolyDataWriter()
writer.SetInputConnection(reconstruction.GetOutputPort())
writer.SetFileName(sys.argv[1] if len(sys.argv) > 1 else "torus.vtp")
close = abs(size.GetVolume() - exact) < 0.001 * exact
sys.exit(0 if writer.Write() and close else 1)
