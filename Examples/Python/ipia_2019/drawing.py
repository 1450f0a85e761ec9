# SPDX-License-Identifier: BSD-3-Clause
"""A sheet of titled tiles in one offscreen window, written as PNG."""

from dataclasses import dataclass

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

from .cloud import points_polydata

BLUE = (0.1, 0.2, 0.8)
RED = (0.85, 0.1, 0.1)
GREEN = (0.1, 0.6, 0.2)
MAGENTA = (0.8, 0.1, 0.7)
BONE = (0.80, 0.75, 0.62)
INK = (0.1, 0.1, 0.1)
WHITE = (1.0, 1.0, 1.0)

TITLE_SIZE = 14
TITLE_HEIGHT = 32  # pixels
MARGIN = 1.06
CAMERA_DISTANCE = 10.0
LINE_WIDTH = 2
BEHIND = (2, 20)  # polygon offset of surfaces: factor and units


@dataclass(frozen=True)
class View:
    """
    A parallel projection. direction points from the model to the viewer. Without a centre the tile
    shows all that is in it, else what is within half_height above and below the centre.
    """

    direction: tuple = (0, 0, 1)
    up: tuple = (0, 1, 0)
    centre: tuple = None
    half_height: float = None


PLANAR_VIEW = View()


class Sheet:
    """
    Rows and columns of tiles, a title above each; tile_size is (width, height) in pixels. With a
    scale everything is drawn so many times as large and then reduced, which makes edges smooth;
    sizes of points and widths of lines are those before.
    """

    def __init__(self, rows, columns, tile_size, scale=1):
        self._rows, self._columns, self._scale = rows, columns, scale
        width, height = tile_size
        self._aspect = width / height
        self._title_share = TITLE_HEIGHT / (height + TITLE_HEIGHT)
        self._window = vtk.vtkRenderWindow()
        self._window.SetOffScreenRendering(1)
        self._window.SetMultiSamples(0)
        self._size = columns * width, rows * (height + TITLE_HEIGHT)
        self._window.SetSize(*(scale * side for side in self._size))
        blank = vtk.vtkRenderer()
        blank.SetBackground(*WHITE)
        self._window.AddRenderer(blank)

    def tile(self, row, column, title, actors, view=PLANAR_VIEW):
        """Draws the tile and returns its renderer."""
        bottom, top = 1 - (row + 1) / self._rows, 1 - row / self._rows
        left, right = column / self._columns, (column + 1) / self._columns
        title_bottom = top - self._title_share * (top - bottom)
        self._add_renderer((left, title_bottom, right, top)).AddActor2D(
            _title(title, self._scale))
        picture = self._add_renderer((left, bottom, right, title_bottom))
        for actor in actors:
            picture.AddActor(actor)
        _aim(picture, actors, view, self._aspect)
        return picture

    def write(self, path):
        self._window.Render()
        picture = vtk.vtkWindowToImageFilter()
        picture.SetInput(self._window)
        picture.ReadFrontBufferOff()
        writer = vtk.vtkPNGWriter()
        writer.SetFileName(str(path))
        writer.SetInputConnection(picture.GetOutputPort())
        if self._scale > 1:
            smaller = vtk.vtkImageResize()
            smaller.SetInputConnection(picture.GetOutputPort())
            smaller.SetOutputDimensions(*self._size, 1)
            writer.SetInputConnection(smaller.GetOutputPort())
        writer.Write()
        self._window.Finalize()

    def _add_renderer(self, viewport):
        renderer = vtk.vtkRenderer()
        renderer.SetBackground(*WHITE)
        renderer.SetViewport(*viewport)
        self._window.AddRenderer(renderer)
        return renderer


def points_actor(points, colour, size=2):
    vertices = vtk.vtkVertexGlyphFilter()
    vertices.SetInputData(points_polydata(points))
    vertices.Update()
    actor = _actor(vertices.GetOutput(), colour)
    actor.GetProperty().SetPointSize(size)
    actor.GetProperty().LightingOff()
    return actor


def curve_actor(contour, colour=RED):
    actor = _actor(contour, colour)
    actor.GetProperty().SetLineWidth(LINE_WIDTH)
    actor.GetProperty().LightingOff()
    return actor


def surface_actor(contour, colour=BONE):
    """A surface, a little behind where it is so that points on it show."""
    actor = _actor(contour, colour)
    if colour == WHITE:
        actor.GetProperty().LightingOff()
    mapper = actor.GetMapper()
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(*BEHIND)
    return actor


def _actor(data, colour):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.ScalarVisibilityOff()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(*colour)
    return actor


def _title(text, scale):
    actor = vtk.vtkTextActor()
    actor.SetInput(text)
    style = actor.GetTextProperty()
    style.SetFontSize(scale * TITLE_SIZE)
    style.SetColor(*INK)
    style.SetJustificationToCentered()
    style.SetVerticalJustificationToCentered()
    actor.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    actor.SetPosition(0.5, 0.5)
    return actor


def _aim(renderer, actors, view, aspect):
    back = np.array(view.direction, dtype=float) / np.linalg.norm(view.direction)
    right = np.cross(view.up, back)
    right /= np.linalg.norm(right)
    up = np.cross(back, right)
    centre, half_height = view.centre, view.half_height
    if centre is None:
        centre, half_height = _frame(actors, right, up, aspect)
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetParallelScale(half_height * MARGIN)
    camera.SetFocalPoint(*centre)
    bounds = np.array(renderer.ComputeVisiblePropBounds()).reshape(3, 2)
    distance = max(CAMERA_DISTANCE, np.linalg.norm(bounds[:, 1] - bounds[:, 0]))
    camera.SetPosition(*(np.asarray(centre) + distance * back))
    camera.SetViewUp(*up)
    renderer.ResetCameraClippingRange()


def _frame(actors, right, up, aspect):
    """Centre and half height of the rectangle of that aspect that holds everything, as seen."""
    data = [actor.GetMapper().GetInput() for actor in actors]
    seen = np.vstack([vtk_to_numpy(part.GetPoints().GetData()) for part in data
                      if part.GetNumberOfPoints()]) @ np.column_stack((right, up))
    low, high = seen.min(axis=0), seen.max(axis=0)
    middle = (low + high) / 2
    width, height = high - low
    return middle[0] * right + middle[1] * up, max(width / aspect, height) / 2
