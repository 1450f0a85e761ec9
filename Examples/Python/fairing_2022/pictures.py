# SPDX-License-Identifier: BSD-3-Clause
"""What the figures draw: curvature combs, histories, zebra stripes and colours of curvature."""

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk

from ipia_2019.cloud import points_polydata
from ipia_2019.drawing import BLUE, GREEN, INK, RED, curve_actor

COMB = (0.45, 0.65, 0.9)
STRIPES = 8  # zebra stripes over the half sphere of normals
EYE = np.array((0.35, -0.5, 0.8))  # the direction to the light of the stripes
HISTORY_COLOURS = {"iteration error": BLUE, "fitting error": RED, "energy": GREEN}


def polyline(points, colour, width=2):
    """One line through points."""
    data = points_polydata(points)
    cells = vtk.vtkCellArray()
    cells.InsertNextCell(len(points))
    for k in range(len(points)):
        cells.InsertCellPoint(k)
    data.SetLines(cells)
    actor = curve_actor(data, colour)
    actor.GetProperty().SetLineWidth(width)
    return actor


def segments(begin, end, colour):
    """A line from each of the points to the other of its number."""
    data = points_polydata(np.vstack((begin, end)))
    cells = vtk.vtkCellArray()
    for k in range(len(begin)):
        cells.InsertNextCell(2)
        cells.InsertCellPoint(k)
        cells.InsertCellPoint(len(begin) + k)
    data.SetLines(cells)
    actor = curve_actor(data, colour)
    actor.GetProperty().SetLineWidth(1)
    return actor


def comb_actors(made, scale, red_box=None, longest=np.inf):
    """
    A curve with its curvature comb, away from the centre of curvature and cut at a longest length; what
    red_box holds is red.
    """
    teeth = scale * made.array("CurvatureNormal")
    lengths = np.maximum(np.linalg.norm(teeth, axis=1, keepdims=True), 1e-300)
    ends = made.points - teeth * np.minimum(1, longest / lengths)
    actors = [segments(made.points, ends, COMB), polyline(ends, COMB, 1),
              polyline(made.points, INK)]
    if red_box is not None:
        u = made.array("Parameter")
        actors += [polyline(made.points[(u >= low) & (u <= high)], RED, 3) for low, high in red_box]
    return actors


def history_actors(made):
    """
    Iteration error, fitting error and energy over the iterations, each relative to its largest value,
    in the square [0, 1]^2.
    """
    axes = np.array(((0, 1, 0), (0, 0, 0), (1, 0, 0)))
    actors = [polyline(axes, INK, 1)]
    count = len(made.iteration_errors)
    for name, values in (("iteration error", made.iteration_errors),
                         ("fitting error", made.fitting_errors), ("energy", made.energies)):
        points = np.column_stack((np.linspace(0, 1, count), values / values.max(), np.zeros(count)))
        actors.append(polyline(points, HISTORY_COLOURS[name]))
    return actors


def zebra_actor(made):
    """Stripes of equal angle between normal and light, as a car body shows them."""
    normals = made.array("Normals")
    angle = np.arccos(np.clip(normals @ EYE / np.linalg.norm(EYE), -1, 1))
    stripes = np.sin(2 * STRIPES * angle)
    table = vtk.vtkLookupTable()
    table.SetNumberOfTableValues(2)
    table.SetTableValue(0, 0.1, 0.1, 0.1, 1)
    table.SetTableValue(1, 1, 1, 1, 1)
    return _coloured(made.output, stripes, "Zebra", table, (-1, 1))


def curvature_actor(made, largest):
    """|H| from blue, 0, to red, `largest` and above."""
    table = vtk.vtkLookupTable()
    table.SetHueRange(0.667, 0)
    table.Build()
    return _coloured(made.output, np.abs(made.array("MeanCurvature")), "|H|", table, (0, largest))


def _coloured(data, values, name, table, value_range):
    shown = vtk.vtkPolyData()
    shown.ShallowCopy(data)
    array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    array.SetName(name)
    shown.GetPointData().SetScalars(array)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(shown)
    mapper.SetLookupTable(table)
    mapper.SetScalarRange(*value_range)
    mapper.InterpolateScalarsBeforeMappingOn()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    return actor

