# SPDX-License-Identifier: BSD-3-Clause
"""What the scripts of the tasks have in common: options, normals, figures, pictures."""
import argparse
from pathlib import Path
import sys

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

# pylint: disable=wrong-import-position
import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

from ipia_2019.drawing import INK, surface_actor
from reconstruct import polydata

SAND = (0.90, 0.80, 0.64)
SLATE = (0.16, 0.36, 0.56)
SCALE = 2  # pictures are drawn so many times as large, then reduced
NEIGHBOURS = 16  # of a point, from which its normal is estimated


def options(description):
    """The options that every task has."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--data", type=Path, default=Path("build/data"),
                        help="the unpacked data of Debian's package libcgal-demo, with meshes/, "
                             "points_3/ and images/ (default: %(default)s)")
    parser.add_argument("--output", type=Path, default=Path("ipia-output/tasks"),
                        help="folder of surface and picture (default: %(default)s)")
    parser.add_argument("--no-picture", action="store_true",
                        help="draw nothing (needs no display)")
    given = parser.parse_args()
    if not (given.data / "meshes").is_dir():
        parser.error(f"no meshes/ in {given.data}: bash Examples/tasks.sh unpacks the data")
    given.output.mkdir(parents=True, exist_ok=True)
    return given


def points_of(data):
    """Its points as an (n, 3) array of doubles."""
    return vtk_to_numpy(data.GetPoints().GetData()).astype(float)


def estimated_normals(points, seen_from, neighbours=NEIGHBOURS):
    """Unit normals across the plane of the nearest points, towards a place that saw all of them."""
    centre = points.mean(axis=0)  # vtkPCANormalEstimation has single precision
    estimate = vtk.vtkPCANormalEstimation()
    estimate.SetInputData(polydata(points - centre))
    estimate.SetSampleSize(neighbours)
    estimate.SetNormalOrientationToPoint()
    estimate.SetOrientationPoint(*(np.asarray(seen_from) - centre))
    estimate.Update()
    return vtk_to_numpy(estimate.GetOutput().GetPointData().GetNormals()).astype(float)


def write(surface, path):
    """As .vtp, which keeps double precision; PLY files have single."""
    writer = vtk.vtkXMLPolyDataWriter()
    writer.SetInputData(surface)
    writer.SetFileName(str(path))
    writer.Write()


def show(name, *values):
    """One line: what was measured, and its values with their units."""
    print(f"{name:<54}" + " ".join(str(value) for value in values), flush=True)


def dots(data, colour=SLATE, size=2.0):
    """Points, in their own colours if they have any; the size is that in the picture."""
    vertices = vtk.vtkVertexGlyphFilter()
    vertices.SetInputData(data)
    vertices.Update()
    actor = _actor(vertices.GetOutput())
    actor.GetProperty().SetColor(*colour)
    actor.GetProperty().SetPointSize(SCALE * size)
    actor.GetProperty().LightingOff()
    return actor


def shaded(surface, colour=SAND):
    """A surface, in its own colours if it has any."""
    actor = surface_actor(surface, colour)
    actor.GetMapper().SetScalarVisibility(surface.GetPointData().GetScalars() is not None)
    actor.GetProperty().SetSpecular(0.15)
    actor.GetProperty().SetSpecularPower(20)
    return actor


def _actor(data):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(data)
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    return actor


def light(renderer):
    """Key, fill and back light in place of the lamp on the viewer's head."""
    vtk.vtkLightKit().AddLightsToRenderer(renderer)


def lines(data, colour=INK, width=1.0):
    """Polylines; the width is that in the picture."""
    actor = _actor(data)
    actor.GetMapper().ScalarVisibilityOff()
    actor.GetProperty().SetColor(*colour)
    actor.GetProperty().SetLineWidth(SCALE * width)
    actor.GetProperty().LightingOff()
    return actor


def colour_range(low, high, colours):
    """A table of colours from low to high, evenly through those given."""
    transfer = vtk.vtkColorTransferFunction()
    for k, colour in enumerate(colours):
        transfer.AddRGBPoint(low + (high - low) * k / (len(colours) - 1), *colour)
    return transfer


def add_scale(renderer, transfer, digits):
    """The colours of a surface and their values, in the lower left corner of its tile."""
    bar = vtk.vtkScalarBarActor()
    bar.SetLookupTable(transfer)
    bar.SetNumberOfLabels(3)
    bar.SetLabelFormat(digits)
    bar.SetOrientationToHorizontal()
    bar.SetUnconstrainedFontSize(True)
    style = bar.GetLabelTextProperty()
    style.SetColor(*INK)
    style.SetFontSize(SCALE * 12)
    style.SetShadow(False)
    style.SetItalic(False)
    style.SetBold(False)
    bar.GetPositionCoordinate().SetValue(0.04, 0.02)
    bar.SetWidth(0.25)
    bar.SetHeight(0.1)
    bar.SetBarRatio(0.4)
    renderer.AddActor2D(bar)
