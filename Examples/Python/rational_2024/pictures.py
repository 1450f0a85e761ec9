# SPDX-License-Identifier: BSD-3-Clause
"""The figures: f as colours, blue inside over white to red outside, f = 0 black, points green."""

import vtk

from ipia_2019.drawing import GREEN, INK, Sheet, curve_actor, points_actor

from .examples import TABLE_1, TABLE_2, TABLE_3, TABLE_4, cloud
from .fitting import fit

TILE = (300, 300)
LARGEST_COLOUR = 0.05  # five offset values
STATES = (1, 10, 100, 1000)


def example_figure(lab, example):
    """All fits of one example in a table, side by side."""
    rows = [row for row in TABLE_1 + TABLE_2 + TABLE_4 if row.example == example]
    sheet = Sheet(1, len(rows), TILE)
    for column, row in enumerate(rows):
        _tile(sheet, 0, column, row.label, lab.cloud(row.example), lab.fit(row))
    return sheet


def states_figure(lab):
    """Fig. 15: iterations of Example 6 with lambda, and below without."""
    rows = [row for row in TABLE_2 if row.example == 6]
    sheet = Sheet(2, len(STATES), TILE)
    points = lab.cloud(6)
    for line, row in enumerate(reversed(rows)):
        for column, count in enumerate(STATES):
            made = fit(points, row.settings.but(iterations=count, tolerance=0.0))
            _tile(sheet, line, column, f"{row.label}, after {count}", points, made)
    return sheet


def sensitivity_figure(lab):
    """Fig. 16: Example 8 for each lambda."""
    sheet = Sheet(2, 3, TILE)
    for i, row in enumerate(TABLE_3):
        _tile(sheet, i // 3, i % 3, row.label, lab.cloud(8), lab.fit(row))
    return sheet


def _tile(sheet, row, column, title, points, made):
    if isinstance(made, str):
        sheet.tile(row, column, f"{title}: refused", [points_actor(points.points, GREEN, size=2)])
        return
    # Each a little in front of the one before.
    curve, dots = curve_actor(made.contour, INK), points_actor(points.points, GREEN, size=2)
    curve.SetPosition(0, 0, 0.01)
    dots.SetPosition(0, 0, 0.02)
    sheet.tile(row, column, f"{title}: {made.extra} extra", [_field_actor(made.field), curve, dots])


def _field_actor(field):
    geometry = vtk.vtkImageDataGeometryFilter()
    geometry.SetInputData(field)
    geometry.Update()
    colours = vtk.vtkColorTransferFunction()
    colours.SetColorSpaceToDiverging()
    colours.AddRGBPoint(-LARGEST_COLOUR, 0.23, 0.3, 0.75)
    colours.AddRGBPoint(LARGEST_COLOUR, 0.7, 0.02, 0.15)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(geometry.GetOutput())
    mapper.SetLookupTable(colours)
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().LightingOff()
    return actor


FIGURES = {f"example{n}": (lambda lab, n=n: example_figure(lab, n))
           for n in (1, 2, 3, 4, 5, 6, 7, 9, 10, 11)}
FIGURES["fig15"] = states_figure
FIGURES["fig16"] = sensitivity_figure
