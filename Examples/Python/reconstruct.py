#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""From a file of points to a surface, or in the plane a curve, with nothing set.

    python3 reconstruct.py scan.ply --output ipia-output

reads, reconstructs, measures and draws, and writes surface.vtp, surface.ply (single precision, no
normals), f.vti and picture.png there. Point arrays of the file, such as colours, are on the surface, the
colours also in surface.ply. Where there is no display, which the picture needs, the script runs
itself under xvfb-run, if that is installed.
"""
import argparse
import contextlib
import os
import re
import shutil
import sys
import tempfile
import time

import numpy as np
from ipia import vtkIPIASurfaceReconstruction
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersCore import (
    vtkImplicitPolyDataDistance,
    vtkPolyDataConnectivityFilter,
    vtkPolyDataNormals,
)
from vtkmodules.vtkFiltersPoints import vtkPCANormalEstimation
from vtkmodules.vtkImagingHybrid import vtkSampleFunction
from vtkmodules.vtkIOGeometry import vtkOBJReader
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkIOPLY import vtkPLYReader, vtkPLYWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter, vtkXMLPolyDataReader, vtkXMLPolyDataWriter

TEXT_SUFFIXES = (".xyz", ".pts", ".pwn")
READERS = {".ply": vtkPLYReader, ".vtp": vtkXMLPolyDataReader, ".obj": vtkOBJReader}
SUFFIXES = tuple(READERS) + TEXT_SUFFIXES

PICTURE = (1600, 800)  # pixels
NEIGHBOURS = 16  # of a point, from which its normal is estimated
MOST_MEASURED = 100_000  # points whose distance to the surface is measured one by one
MOST_SAMPLES = 4_000_000  # of f in f.vti, evaluated one by one


class UserError(Exception):
    """Something about the user's file or machine, told in one line."""


class Stage:
    """One line of text per stage: its name, the progress of its algorithm if any, its duration."""

    WIDTH = len("0...10...20...30...40...50...60...70...80...90...100")

    def __init__(self, name, algorithm=None):
        self.algorithm = algorithm
        self.shown = -1
        self.warnings = []
        self.errors = []
        print(f"{name:<10}", end="", flush=True)

    def __enter__(self):
        self.start = time.perf_counter()
        if self.algorithm:
            self.algorithm.AddObserver("ProgressEvent", self._advance)
            for event, messages in (("WarningEvent", self.warnings), ("ErrorEvent", self.errors)):
                self._collect(event, messages)
        return self

    def __exit__(self, kind, value, trace):
        if kind:
            print(flush=True)
            return
        if self.algorithm:
            self._show(10)
        else:
            print(" " * self.WIDTH, end="")
        print(f"{time.perf_counter() - self.start:8.2f} s")
        for message in self.warnings:
            print(f"  warning: {message}")

    def _collect(self, event, messages):
        def collect(_caller, _event, message):
            messages.append(one_line(message))

        collect.CallDataType = "string0"
        self.algorithm.AddObserver(event, collect)

    def _advance(self, algorithm, _event):
        self._show(int(10 * algorithm.GetProgress()))

    def _show(self, tens):
        while self.shown < tens:
            self.shown += 1
            dots = "..." if self.shown else ""
            print(f"{dots}{10 * self.shown}", end="", flush=True)


def one_line(message):
    """The text of a VTK message, without the place in the source and the name of the object."""
    text = " ".join(message.split("| ", 1)[-1].split())
    return text.split("): ", 1)[1] if "): " in text else text


def polydata(points, normals=None):
    """vtkPolyData of (n, 3) arrays."""
    data = vtkPolyData()
    vtk_points = vtkPoints()
    vtk_points.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
    data.SetPoints(vtk_points)
    if normals is not None:
        array = numpy_to_vtk(np.ascontiguousarray(normals), deep=True)
        array.SetName("Normals")
        data.GetPointData().SetNormals(array)
    return data


def moved(data, by):
    """The data with its points moved, in double precision."""
    points = vtkPoints()
    points.SetData(numpy_to_vtk(vtk_to_numpy(data.GetPoints().GetData()) + np.array(by), deep=True))
    result = vtkPolyData()
    result.ShallowCopy(data)
    result.SetPoints(points)
    return result


def looks_like_colours(columns):
    """Whole numbers from 0 to 255, not all of them 0 or 1: red, green and blue, no normals."""
    return bool(
        np.all(columns == np.floor(columns)) and columns.min() >= 0 and 1 < columns.max() <= 255
    )


def coloured(data, columns):
    """The data with red, green and blue from 0 to 255, as vtkPLYReader would have them."""
    array = numpy_to_vtk(np.ascontiguousarray(columns, dtype=np.uint8), deep=True)
    array.SetName("RGB")
    data.GetPointData().SetScalars(array)
    return data


def read_text(path):
    """Points, and normals where columns 4 to 6 are normals, of a file of one point a line.

    The first line may be the number of points. Then .pwn files may hold the points and after them
    the normals, each with three columns. Red, green and blue (0 to 255) may follow the points, an
    intensity after these, or the normals; further columns are not used.
    """
    with open(path, encoding="utf-8") as file:
        lines = file.read().replace(",", " ").splitlines()
    while lines and not lines[0].split("#", 1)[0].strip():
        lines.pop(0)
    count = None
    if lines and lines[0].strip().isdigit():
        count = int(lines.pop(0))
    if not lines:
        raise UserError("it has no points")
    try:
        table = np.loadtxt(lines, ndmin=2)
    except ValueError as error:
        if "columns changed" in str(error):
            raise UserError("its lines have different numbers of columns") from error
        raise UserError(f"it is not a table of numbers ({error})") from error
    width = table.shape[1]
    if width < 3:
        raise UserError(f"its lines have {width} columns; at least x y z are needed")
    if width == 3 and count is not None and len(table) == 2 * count:
        return polydata(table[:count], table[count:])
    if count is not None and count != len(table):
        raise UserError(f"its first line announces {count} points, but {len(table)} lines follow")
    if width == 7 and looks_like_colours(table[:, 4:]):
        return coloured(polydata(table[:, :3]), table[:, 4:])
    if width >= 6 and looks_like_colours(table[:, 3:6]):
        return coloured(polydata(table[:, :3]), table[:, 3:6])
    if width < 6:
        return polydata(table[:, :3])
    data = polydata(table[:, :3], table[:, 3:6])
    if width >= 9 and looks_like_colours(table[:, 6:9]):
        return coloured(data, table[:, 6:9])
    return data


def read(path):
    """The file as vtkPolyData; UserError says what is wrong with it."""
    suffix = os.path.splitext(path)[1].lower()
    if suffix not in SUFFIXES:
        raise UserError(f"the suffix '{suffix}' is not one of {' '.join(SUFFIXES)}")
    if os.path.isdir(path):
        raise UserError("it is a folder")
    try:
        with open(path, "rb") as file:
            start = file.read(4)
        if suffix in TEXT_SUFFIXES:
            return read_text(path)
    except OSError as error:
        raise UserError(error.strerror) from error
    except UnicodeDecodeError as error:
        raise UserError("it is not a text file") from error
    if suffix == ".ply" and start[:3] != b"ply":
        raise UserError("it does not begin with 'ply'")
    reader = READERS[suffix]()
    reader.SetFileName(path)
    with captured_stderr() as messages:
        reader.Update()
    if messages:
        raise UserError(f"it cannot be read ({one_line(messages[0])})")
    return reader.GetOutput()


@contextlib.contextmanager
def captured_stderr():
    """The lines that VTK's readers and the C code in them write to the standard error output."""
    lines = []
    sys.stderr.flush()
    kept = os.dup(2)
    with tempfile.TemporaryFile() as file:
        os.dup2(file.fileno(), 2)
        try:
            yield lines
        finally:
            os.dup2(kept, 2)
            os.close(kept)
            file.seek(0)
            text = re.sub(r"\x1b\[\d*m", "", file.read().decode(errors="replace"))
            lines.extend(line for line in text.splitlines() if line.strip())


def given_normals(data):
    """The point normals of the data as an (n, 3) array, or None."""
    arrays = data.GetPointData()
    found = arrays.GetNormals() or arrays.GetArray("Normals") or arrays.GetArray("normals")
    if not found or found.GetNumberOfComponents() != 3:
        return None
    normals = vtk_to_numpy(found).astype(float)
    return normals if np.any(np.nan_to_num(normals)) else None


def share_pointing_outward(points, normals):
    """Share of the outermost points, in 26 directions, whose normal points outward."""
    steps = (-1, 0, 1)
    directions = np.array([(x, y, z) for x in steps for y in steps for z in steps if x or y or z])
    outermost = np.argmax(points @ directions.T, axis=0)
    return np.mean(np.sum(normals[outermost] * directions, axis=1) > 0)


def colours(data):
    """The name of the red, green and blue values that VTK's readers give points, or None."""
    for name in ("RGB", "RGBA"):
        array = data.GetPointData().GetArray(name)
        if array and array.GetDataTypeAsString() == "unsigned char":
            return name
    return None


def with_normals_and_arrays(data):
    """The points with normals and all the other point arrays, and how the normals came about."""
    points, how = with_normals(data)
    arrays = data.GetPointData()
    for i in range(arrays.GetNumberOfArrays()):
        array = arrays.GetAbstractArray(i)
        if array.GetName() and array.GetName().lower() != "normals":
            points.GetPointData().AddArray(array)
    if colours(points):
        points.GetPointData().SetActiveScalars(colours(points))
    return points, how


def with_normals(data):
    """The points with normals, and how these came about."""
    points = vtk_to_numpy(data.GetPoints().GetData()).astype(float)
    normals = given_normals(data)
    if normals is not None:
        return polydata(points, normals), "as given in the file"
    if data.GetNumberOfPolys() > 0:
        vertex = vtkPolyDataNormals()
        vertex.SetInputData(data)
        vertex.SplittingOff()
        vertex.SetAutoOrientNormals(number_of_open_edges(data) == 0)
        vertex.Update()
        normals = vtk_to_numpy(vertex.GetOutput().GetPointData().GetNormals())
        return polydata(points, normals), "of the faces of the file, which has none of its own"
    estimate = vtkPCANormalEstimation()
    estimate.SetInputData(polydata(points - points.mean(axis=0)))
    estimate.SetSampleSize(NEIGHBOURS)
    estimate.SetNormalOrientationToGraphTraversal()
    estimate.Update()
    normals = vtk_to_numpy(estimate.GetOutput().GetPointData().GetNormals()).copy()
    outward = share_pointing_outward(points, normals)
    if outward < 0.5:
        normals, outward = -normals, 1 - outward
    how = f"estimated from the {NEIGHBOURS} nearest points: the file has none"
    if outward < 0.9:
        how += (
            f"\n  warning: only {100 * outward:.0f} % of the outermost normals point outward; "
            "where their side is wrong the surface will be, too"
        )
    return polydata(points, normals), how


def number_of_open_edges(surface):
    """Edges of a single face. vtkFeatureEdges of VTK 9.1 takes memory by the square of the points."""
    corners = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).astype(np.int64)
    offsets = vtk_to_numpy(surface.GetPolys().GetOffsetsArray())
    following = np.roll(corners, -1)
    following[offsets[1:] - 1] = corners[offsets[:-1]]
    smaller, larger = np.minimum(corners, following), np.maximum(corners, following)
    faces = np.unique(smaller * surface.GetNumberOfPoints() + larger, return_counts=True)[1]
    return int(np.count_nonzero(faces == 1))


def number_of_components(surface):
    components = vtkPolyDataConnectivityFilter()
    components.SetInputData(surface)
    components.SetExtractionModeToAllRegions()
    components.Update()
    return components.GetNumberOfExtractedRegions()


def sampler(fitter):
    """The fitted function as an image, sampled at its knots or as finely as MOST_SAMPLES allows."""
    spacings = np.maximum(np.array(fitter.GetGridSizeUsed()) - 3, 0)  # 0 across a plane
    shrink = min(1.0, (MOST_SAMPLES / np.prod(spacings + 1.0)) ** (1 / np.count_nonzero(spacings)))
    sample = vtkSampleFunction()
    sample.SetImplicitFunction(fitter.GetImplicitFunction())
    sample.SetModelBounds(fitter.GetModelBoundsUsed())
    sample.SetSampleDimensions(*(int(n * shrink) + 1 for n in spacings))
    sample.SetOutputScalarTypeToFloat()
    sample.SetScalarArrayName("f")
    sample.ComputeNormalsOff()
    return sample


def picked(points):
    """At most MOST_MEASURED of them, evenly."""
    if len(points) <= MOST_MEASURED:
        return points
    return points[np.linspace(0, len(points) - 1, MOST_MEASURED).astype(int)]


def distances(points, surface):
    """True distances of the points to the triangles."""
    measure = vtkImplicitPolyDataDistance()
    measure.SetInput(surface)
    values = numpy_to_vtk(np.zeros(len(points)), deep=True)
    measure.FunctionValue(numpy_to_vtk(np.ascontiguousarray(points), deep=True), values)
    return np.abs(vtk_to_numpy(values))


def distances_by_function(points, function):
    """Distances of the points to f = 0 to first order, |f| / |grad f|."""
    values = np.array([function.FunctionValue(point) for point in points])
    slopes = np.linalg.norm([function.FunctionGradient(point) for point in points], axis=1)
    return np.abs(values) / np.where(slopes > 0, slopes, 1)


def write(writer, data, path, binary=True):
    writer.SetInputData(data)
    writer.SetFileName(path)
    if binary and hasattr(writer, "SetDataModeToAppended"):
        writer.SetDataModeToAppended()
        writer.EncodeAppendedDataOff()
    if not writer.Write():
        raise UserError(f"{path} cannot be written")


def draw(data, surface, path):
    """A picture of the points beside the surface, both seen from the same side."""
    # Loaded only here: rendering needs a display where VTK is built for X, nothing else does.
    import vtkmodules.vtkRenderingFreeType  # noqa: F401 (draws text)
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 (implements the classes below)
    from vtkmodules.vtkFiltersGeneral import vtkVertexGlyphFilter
    from vtkmodules.vtkImagingCore import vtkImageResize
    from vtkmodules.vtkRenderingCore import (
        vtkActor,
        vtkLightKit,
        vtkPolyDataMapper,
        vtkRenderer,
        vtkRenderWindow,
        vtkTextActor,
        vtkWindowToImageFilter,
    )

    # Single precision on the graphics card: everything is drawn near the origin.
    bounds = np.array(data.GetBounds()).reshape(3, 2)
    centre, sides = bounds.mean(axis=1), bounds[:, 1] - bounds[:, 0]

    def caption(text):
        actor = vtkTextActor()
        actor.SetInput(text)
        actor.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
        actor.SetPosition(0.03, 0.03)
        actor.GetTextProperty().SetFontSize(2 * 20)
        actor.GetTextProperty().SetColor(0.25, 0.27, 0.3)
        return actor

    vertices = vtkVertexGlyphFilter()
    vertices.SetInputData(moved(data, -centre))
    vertices.Update()
    faces = surface.GetNumberOfPolys()
    views = (
        (vertices.GetOutput(), (0.16, 0.36, 0.56), f"{data.GetNumberOfPoints():,} points"),
        (
            moved(surface, -centre),
            (0.90, 0.76, 0.55),
            f"fitted surface, {faces:,} triangles" if faces else "fitted curve",
        ),
    )
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    # Drawn twice as large and made smaller: smooth edges everywhere.
    window.SetSize(2 * PICTURE[0], 2 * PICTURE[1])
    camera = view(vtk_to_numpy(vertices.GetOutput().GetPoints().GetData()), sides)
    for i, (part, colour, text) in enumerate(views):
        mapper = vtkPolyDataMapper()
        mapper.SetInputData(part)
        mapper.SetScalarVisibility(colours(part) is not None)
        actor = vtkActor()
        actor.SetMapper(mapper)
        look = actor.GetProperty()
        look.SetColor(colour)
        look.SetPointSize(3 if data.GetNumberOfPoints() > 20_000 else 5)
        look.SetLineWidth(5)
        look.SetLighting(part.GetNumberOfLines() == 0)
        look.SetSpecular(0.15)
        look.SetSpecularPower(20)
        renderer = vtkRenderer()
        renderer.SetViewport(i / 2, 0, (i + 1) / 2, 1)
        renderer.SetBackground(1, 1, 1)
        renderer.SetBackground2(0.86, 0.89, 0.93)
        renderer.GradientBackgroundOn()
        renderer.AddActor(actor)
        renderer.AddViewProp(caption(text))
        vtkLightKit().AddLightsToRenderer(renderer)
        renderer.SetActiveCamera(camera)
        renderer.ResetCameraClippingRange()
        window.AddRenderer(renderer)
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    smaller = vtkImageResize()
    smaller.SetInputConnection(grab.GetOutputPort())
    smaller.SetOutputDimensions(PICTURE[0], PICTURE[1], 1)
    writer = vtkPNGWriter()
    writer.SetInputConnection(smaller.GetOutputPort())
    writer.SetFileName(path)
    writer.Write()


def view(points, sides):
    """The camera: a map from above its edge, a plane head-on, all else with y up, from the front."""
    from vtkmodules.vtkRenderingCore import vtkCamera

    flat = int(np.argmin(sides))
    if sides[flat] == 0:
        towards, up = np.eye(3)[flat], np.eye(3)[1 if flat == 2 else 2]
    elif flat == 2 and sides[2] < 0.5 * np.sort(sides)[1]:
        towards, up = np.array([-0.45, -1, 0.75]), np.array([0, 0, 1])
    else:
        towards, up = np.array([0.35, 0.25, 1]), np.array([0, 1, 0])
    right = np.cross(up, towards)
    right /= np.linalg.norm(right)
    upward = np.cross(towards, right) / np.linalg.norm(towards)
    across, along = points @ right, points @ upward
    middle = (across.min() + across.max()) / 2 * right + (along.min() + along.max()) / 2 * upward
    camera = vtkCamera()
    camera.ParallelProjectionOn()
    camera.SetParallelScale(0.55 * max(np.ptp(across), 1.05 * np.ptp(along)))
    camera.SetFocalPoint(*middle)
    camera.SetPosition(*(middle + np.linalg.norm(sides) * towards))
    camera.SetViewUp(*up)
    return camera


def times(numbers):
    return " x ".join(str(n) for n in numbers)


def summary(name, values, diagonal):
    """Mean, 99 % and maximum, in world units and in per cent of the diagonal."""
    figures = (np.mean(values), np.percentile(values, 99), np.max(values))
    return f"  {name:<24}" + "".join(f"{v:>11.4g} {100 * v / diagonal:6.3f} %" for v in figures)


def reconstruct(path, folder, picture):
    """All stages, one line each; then what came out, and where it is."""
    print(f"file      {path}")
    with Stage("read"):
        data = read(path)
        if data.GetNumberOfPoints() == 0:
            raise UserError("it has no points")
    with Stage("normals"):
        data, how = with_normals_and_arrays(data)
    print(f"  {data.GetNumberOfPoints():,} points; normals {how}")

    reconstruction = vtkIPIASurfaceReconstruction()
    reconstruction.SetInputData(data)
    with Stage("surface", reconstruction) as stage:
        reconstruction.Update()
        if stage.errors:
            raise UserError(stage.errors[0])
    surface, fitter = reconstruction.GetOutput(), reconstruction.GetFitter()
    if surface.GetNumberOfPoints() == 0:
        raise UserError("the fit has no surface in its domain; do the normals point to all sides?")
    function = sampler(fitter)
    with Stage("sample f", function):
        function.Update()

    with Stage("measure"):
        points = vtk_to_numpy(data.GetPoints().GetData())
        points = picked(points[np.isfinite(points).all(axis=1)])
        diagonal = np.linalg.norm(np.ptp(points, axis=0))
        by_function = distances_by_function(points, fitter.GetImplicitFunction())
        by_faces = distances(points, surface) if surface.GetNumberOfPolys() else None
        components = number_of_components(surface)

    try:
        os.makedirs(folder, exist_ok=True)
    except OSError as error:
        raise UserError(f"{folder}: {error.strerror}") from error
    files = {
        "surface": os.path.join(folder, "surface.vtp"),
        "also": os.path.join(folder, "surface.ply"),
        "function": os.path.join(folder, "f.vti"),
    }
    with Stage("write"):
        write(vtkXMLPolyDataWriter(), surface, files["surface"])
        writer = vtkPLYWriter()
        if colours(surface):
            writer.SetArrayName(colours(surface))
            writer.SetEnableAlpha(colours(surface) == "RGBA")
        write(writer, surface, files["also"])
        write(vtkXMLImageDataWriter(), function.GetOutput(), files["function"])
    if picture:
        files["picture"] = os.path.join(folder, "picture.png")
        with Stage("draw"):
            draw(data, surface, files["picture"])

    size, samples = fitter.GetGridSizeUsed(), function.GetOutput().GetDimensions()
    print(f"\nlattice {times(size)} coefficients, {fitter.GetNumberOfLevelsUsed()} levels; ", end="")
    print(f"f.vti {times(samples)} samples")
    if fitter.GetSmoothingLengthUsed() > 0:
        print(f"noise of {fitter.GetNoiseFound():.4g} found, ", end="")
        print(f"smoothed below a length of {fitter.GetSmoothingLengthUsed():.4g}")
    if by_faces is None:
        print(f"curve of {surface.GetNumberOfPoints():,} points, ", end="")
    else:
        edges = number_of_open_edges(surface)
        trimmed = reconstruction.GetNumberOfPartsTrimmed() > 0
        where = "the points end" if trimmed else "it meets the domain's sides"
        closed = "closed" if edges == 0 else f"{edges} open edges, where {where}"
        print(f"surface of {surface.GetNumberOfPolys():,} triangles, {closed}, ", end="")
    print(f"{components} component{'s' if components != 1 else ''}", end="")
    left_out = reconstruction.GetNumberOfComponentsLeftOut()
    print(f" ({left_out} without data left out)" if left_out else "")
    print(f"distance of the points  {'mean':>13}{'99 %':>20}{'max':>20}   (% of the diagonal)")
    if by_faces is not None:
        print(summary("to the triangles", by_faces, diagonal))
    print(summary("to f = 0 (|f| / |grad f|)", by_function, diagonal))
    print()
    for name, file in files.items():
        print(f"{name:<9} {file}")


def main():
    parser = argparse.ArgumentParser(
        description="Fit a surface to a file of points.",
        epilog="Points without normals get the normals of the file's faces, or estimated ones.",
    )
    parser.add_argument("file", help=f"points, with or without normals ({' '.join(SUFFIXES)})")
    parser.add_argument("-o", "--output", default="ipia-output", help="folder for the results")
    parser.add_argument("--no-picture", action="store_true", help="draw nothing (needs no display)")
    arguments = parser.parse_args()
    picture = not arguments.no_picture
    if picture and sys.platform == "linux" and not os.environ.get("DISPLAY"):
        if shutil.which("xvfb-run"):
            os.execvp("xvfb-run", ["xvfb-run", "-a", sys.executable, *sys.argv])
        print("no picture will be drawn: there is neither a display nor xvfb-run", file=sys.stderr)
        picture = False
    try:
        reconstruct(arguments.file, arguments.output, picture)
    except UserError as error:
        print(f"error: {arguments.file}: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
