# SPDX-License-Identifier: BSD-3-Clause
"""One fit of classic I-PIA: the filter with the settings of this reproduction, and its contour."""

from dataclasses import dataclass, replace
import time

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

from ipia import vtkIPIAImplicitFitter

from .cloud import points_polydata

# All models are centred with longest side 1; the domain is a cube (square) around them.
DOMAIN_HALF_SIDE = 0.6
ITERATIONS = 100

# Samples per knot spacing of planar fits, whose contour is drawn as it is (3-D: the default, 2).
PLANAR_SAMPLES_PER_SPACING = 8

# Offset positions outside the domain are left out, so this leaves out all rows of the normals.
NO_OFFSET_ROWS = 100 * DOMAIN_HALF_SIDE


@dataclass(frozen=True)
class Settings:
    """What a fit is asked for; the distances and values of 0 are the filter's automatic ones."""

    grid: int
    planar: bool = False
    iterations: int = ITERATIONS
    two_sided: bool = True
    offset_distance: float = 0.0
    offset_value: float = 0.0
    half_side: float = DOMAIN_HALF_SIDE

    def but(self, **changes):
        return replace(self, **changes)


@dataclass(frozen=True)
class Fit:
    """The contour f = 0 and what is to be said about it."""

    contour: vtk.vtkPolyData
    components: int
    closed: bool
    seconds: float
    max_error: float
    offset_distance: float
    warnings: tuple


def fit(cloud, settings, extra_rows=None):
    """
    Fits a cloud. extra_rows: (points, values) at which f shall take the values; then the normals
    give no rows, and the offset value is only the magnitude of the far field.
    """
    fitter = vtkIPIAImplicitFitter()
    messages = _record_messages(fitter)
    fitter.SetInputData(cloud.polydata())
    _apply(fitter, settings)
    if extra_rows is not None:
        fitter.SetExtraRowsData(points_polydata(*extra_rows))
        fitter.SetNormalConstraintToOutwardOffset()
        fitter.SetOffsetDistance(NO_OFFSET_ROWS)
    start = time.perf_counter()
    fitter.Update()
    seconds = time.perf_counter() - start
    if messages["ErrorEvent"]:
        raise RuntimeError(messages["ErrorEvent"][0])
    contour = _contour(fitter, settings.planar)
    return Fit(contour=contour, components=_component_count(contour),
               closed=_is_closed(contour, settings.planar), seconds=seconds,
               max_error=fitter.GetMaximumError(), offset_distance=fitter.GetOffsetDistanceUsed(),
               warnings=tuple(messages["WarningEvent"]))


def _apply(fitter, settings):
    side = (-settings.half_side, settings.half_side)
    if settings.planar:
        samples = PLANAR_SAMPLES_PER_SPACING * (settings.grid - 3) + 1
        fitter.SetModelBounds(*side, *side, 0.0, 0.0)
        fitter.SetGridSize(settings.grid, settings.grid, 0)
        fitter.SetSampleDimensions(samples, samples, 0)
    else:
        fitter.SetModelBounds(*side, *side, *side)
        fitter.SetGridSize(settings.grid, settings.grid, settings.grid)
    fitter.SetNumberOfLevels(1)
    fitter.SetSolverToProgressiveIteration()
    fitter.SetMaximumNumberOfIterations(settings.iterations)
    if settings.two_sided:
        fitter.SetNormalConstraintToTwoSidedOffset()
    else:
        fitter.SetNormalConstraintToOutwardOffset()
    fitter.SetOffsetDistance(settings.offset_distance)
    fitter.SetOffsetValue(settings.offset_value)


def _record_messages(fitter):
    """Lists that take the filter's errors and warnings instead of the console."""
    messages = {"ErrorEvent": [], "WarningEvent": []}
    for event, found in messages.items():
        def record(_caller, _event, text, found=found):
            found.append(text.split("): ", 1)[-1].strip())
        record.CallDataType = vtk.VTK_STRING
        fitter.AddObserver(event, record)
    return messages


def _contour(fitter, planar):
    contour = vtk.vtkFlyingEdges2D() if planar else vtk.vtkFlyingEdges3D()
    contour.SetInputConnection(fitter.GetOutputPort())
    contour.SetValue(0, 0.0)
    contour.Update()
    return contour.GetOutput()


def _component_count(contour):
    components = vtk.vtkPolyDataConnectivityFilter()
    components.SetInputData(contour)
    components.SetExtractionModeToAllRegions()
    components.Update()
    return components.GetNumberOfExtractedRegions()


def _is_closed(contour, planar):
    """Whether a curve has no end points (a surface no border)."""
    if contour.GetNumberOfCells() == 0:
        return False
    if planar:
        lines = vtk_to_numpy(contour.GetLines().GetConnectivityArray())
        return bool((np.bincount(lines, minlength=contour.GetNumberOfPoints()) == 2).all())
    border = vtk.vtkFeatureEdges()
    border.SetInputData(contour)
    border.FeatureEdgesOff()
    border.ManifoldEdgesOff()
    border.NonManifoldEdgesOff()
    border.BoundaryEdgesOn()
    border.Update()
    return border.GetOutput().GetNumberOfCells() == 0
