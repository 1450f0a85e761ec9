#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Noisy points -> fair curve, then fairer on one segment; as Examples/Cxx/FairCurve.cxx.

    python3 FairCurve.py [curve.vtp]
"""
import sys
from math import cos, pi, sin

from ipia import vtkFairingPIACurveFilter
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkDataObject, vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

FIRST, LAST = 20, 32  # control points of the segment


def make_starfish(count=200):
    """A closed polyline with something like noise."""
    points = vtkPoints()
    lines = vtkCellArray()
    lines.InsertNextCell(count + 1)
    for k in range(count):
        angle = 2 * pi * k / count
        radius = 1 + 0.3 * cos(5 * angle) + 0.01 * sin(1e4 * (k + 1) * (k + 1))
        lines.InsertCellPoint(points.InsertNextPoint(radius * cos(angle), radius * sin(angle), 0))
    lines.InsertCellPoint(0)
    starfish = vtkPolyData()
    starfish.SetPoints(points)
    starfish.SetLines(lines)
    return starfish


starfish = make_starfish()

# A first round: one weight for all control points.
fair = vtkFairingPIACurveFilter()
fair.SetInputData(starfish)
fair.SetNumberOfControlPoints(80)
fair.SetFairingWeight(1e-8)
fair.Update()
fitting_error, energy = fair.GetFittingError(), fair.GetFairingEnergy()
print(f"first round: fitting error {fitting_error:.5f}, strain energy {energy:.6g}")

# A second one from its control points: larger weights on a segment, whose control points alone move.
controls = vtkPolyData()
controls.DeepCopy(fair.GetOutputDataObject(1))
weights = controls.GetPointData().GetArray("FairingWeight")
movable = vtkDoubleArray()
movable.SetName("Movable")
for j in range(controls.GetNumberOfPoints()):
    inside = FIRST <= j <= LAST
    movable.InsertNextValue(inside)
    if inside:
        weights.SetValue(j, 1e-5)
controls.GetPointData().AddArray(movable)
fair.SetControlPointsData(controls)
fair.SetInputArrayToProcess(2, 1, 0, vtkDataObject.FIELD_ASSOCIATION_POINTS, "Movable")
fair.Update()
print(f"second round: fitting error {fair.GetFittingError():.5f}, "
      f"strain energy {fair.GetFairingEnergy():.6g}")

writer = vtkXMLPolyDataWriter()
writer.SetInputConnection(fair.GetOutputPort())
writer.SetFileName(sys.argv[1] if len(sys.argv) > 1 else "curve.vtp")
fairer = fair.GetFairingEnergy() < 0.95 * energy and fair.GetFittingError() < 0.015
sys.exit(0 if writer.Write() and fairer else 1)
