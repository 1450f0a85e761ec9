# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of the plugin have in common: scans, messages, pictures. Run by pvpython or pvbatch."""
import math
import os
import sys

import numpy as np
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkImagingCore import vtkImageDifference
from vtkmodules.vtkIOImage import vtkPNGReader
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

DATA = os.environ.get("IPIA_DATA_DIR", "")
OUTPUT = os.environ.get("IPIA_TEST_OUTPUT", ".")
BASELINE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "Data", "Baseline")
RADIUS = 2.0


def output(name):
    return os.path.join(OUTPUT, name)


def sphere(count=1500, centre=(0, 0, 0)):
    """Points spread evenly over a sphere (a Fibonacci lattice), with outward normals."""
    z = 1 - (2 * np.arange(count) + 1) / count
    angle = np.pi * (1 + 5**0.5) * np.arange(count)
    across = np.sqrt(1 - z * z)
    normals = np.stack((across * np.cos(angle), across * np.sin(angle), z), axis=1)
    return RADIUS * normals + np.array(centre), normals


def kitten():
    """A scan: 5210 points with normals."""
    columns = np.loadtxt(os.path.join(DATA, "points_3", "kitten.xyz"))
    return columns[:, :3], columns[:, 3:6]


def polydata(points, normals=None, **arrays):
    data = vtkPolyData()
    data.SetPoints(vtkPoints())
    data.GetPoints().SetData(numpy_to_vtk(np.ascontiguousarray(points, dtype=float), deep=True))
    vertices = vtkCellArray()
    for i in range(len(points)):
        vertices.InsertNextCell(1, [i])
    data.SetVerts(vertices)
    if normals is not None:
        array = numpy_to_vtk(np.ascontiguousarray(normals, dtype=float), deep=True)
        array.SetName("Normals")
        data.GetPointData().SetNormals(array)
    for name, values in arrays.items():
        array = numpy_to_vtk(np.ascontiguousarray(values, dtype=float), deep=True)
        array.SetName(name)
        data.GetPointData().AddArray(array)
    return data


def write(name, data):
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(output(name))
    writer.SetInputData(data)
    # Not appended, the default, which Debian's ParaView 5.11.0 cannot read with libexpat1 2.5.0-1+deb12u2.
    writer.SetDataModeToBinary()
    assert writer.Write()
    return output(name)


def write_ply(name, points, normals):
    """As scanners write it: vertices with normals, no faces."""
    with open(output(name), "w", encoding="ascii") as file:
        print(f"ply\nformat ascii 1.0\nelement vertex {len(points)}", file=file)
        for field in ("x", "y", "z", "nx", "ny", "nz"):
            print(f"property float {field}", file=file)
        print("end_header", file=file)
        np.savetxt(file, np.hstack((points, normals)), fmt="%.7g")
    return output(name)


def producer(data):
    """A source of data that is here, in builtin and batch sessions."""
    source = simple.TrivialProducer()
    source.GetClientSideObject().SetOutput(data)
    source.UpdatePipeline()
    return source


def fetch(proxy, port=0):
    return servermanager.Fetch(servermanager.OutputPort(proxy.SMProxy, port) if port else proxy)


def faired():
    """The fairing filters on the files of TestPluginParallel.py, by what they fair."""
    lines = simple.XMLPartitionedPolydataReader(FileName=[output("lines.pvtp")])
    pieces = simple.XMLPartitionedStructuredGridReader(FileName=[output("grid.pvts")])
    whole = simple.XMLStructuredGridReader(FileName=[output("grid.vts")])
    direct = {"Solver": "Sparse direct"}
    curve = simple.FairingPIACurve(Input=lines, **direct)
    grid = simple.FairingPIASurface(Input=pieces, Weights=["POINTS", "w"], **direct)
    return {
        "curves": curve,
        "curves again": simple.FairingPIACurve(
            Input=lines, ControlPoints=servermanager.OutputPort(curve, 1), **direct),
        "one block": simple.FairingPIACurve(Input=simple.GroupDatasets(Input=[lines]), **direct),
        "grid": grid,
        "grid again": simple.FairingPIASurface(
            Input=pieces, ControlPoints=servermanager.OutputPort(grid, 1), **direct),
        "grid of one file": simple.FairingPIASurface(Input=whole, **direct),
        "scattered": simple.FairingPIASurface(Input=lines, Parametrization="Given", **direct),
    }


class Messages:
    """Counts what would be in ParaView's message window."""

    def __enter__(self):
        self.errors, self.warnings = [], []
        self.window = vtkOutputWindow.GetInstance()

        def on_error(_caller, _event, text):
            self.errors.append(text)

        def on_warning(_caller, _event, text):
            self.warnings.append(text)

        on_error.CallDataType = on_warning.CallDataType = "string0"
        self.tags = [
            self.window.AddObserver("ErrorEvent", on_error),
            self.window.AddObserver("WarningEvent", on_warning),
        ]
        return self

    def __exit__(self, *_):
        for tag in self.tags:
            self.window.RemoveObserver(tag)


def area_and_volume(surface):
    """Of a closed surface of triangles; the volume is positive where they face outward."""
    x = vtk_to_numpy(surface.GetPoints().GetData()).astype(float)
    x = x - x.mean(axis=0)
    corners = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    a, b, c = (x[corners[:, i]] for i in range(3))
    cross = np.cross(b - a, c - a)
    return np.linalg.norm(cross, axis=1).sum() / 2, np.sum(a * np.cross(b, c)) / 6


def assert_is_sphere(surface, radius=RADIUS, share=0.005):
    area, volume = area_and_volume(surface)
    assert abs(volume / (4 / 3 * math.pi * radius**3) - 1) < share, volume
    assert abs(area / (4 * math.pi * radius**2) - 1) < share, area


def picture(name, *sources, size=(400, 400)):
    """A picture of the sources (shown as they are if none is given)."""
    if sources:
        view = simple.CreateRenderView(ViewSize=list(size), UseColorPaletteForBackground=0,
                                       Background=[1, 1, 1], OrientationAxesVisibility=0)
        view.MultiSamples = 0
        for source in sources:
            display = simple.Show(source, view)
            display.ColorArrayName = [None, ""]
            display.DiffuseColor = [0.85, 0.75, 0.6]
        simple.ResetCamera(view)
    else:
        view = simple.GetActiveViewOrCreate("RenderView")
    simple.Render(view)
    simple.SaveScreenshot(output(name), view, ImageResolution=list(size))
    return output(name)


def read_picture(path):
    reader = vtkPNGReader()
    reader.SetFileName(path)
    reader.Update()
    assert reader.GetOutput().GetNumberOfPoints() > 1, path
    return reader.GetOutput()


def difference(path, other):
    """As VTK's image tests have it."""
    compare = vtkImageDifference()
    compare.SetInputData(read_picture(path))
    compare.SetImageData(read_picture(other))
    compare.Update()
    return compare.GetThresholdedError()


def assert_like_baseline(path, threshold=10):
    baseline = os.path.join(BASELINE, os.path.basename(path))
    assert os.path.exists(baseline), f"no baseline {baseline} for {path}"
    found = difference(path, baseline)
    assert found <= threshold, f"{path} differs from {baseline} by {found}"


def run(tests):
    """The functions test_... of a module, each in an empty session."""
    for name, test in list(tests.items()):
        if name.startswith("test_") and (len(sys.argv) < 2 or sys.argv[1] in name):
            simple.ResetSession()
            test()
            print(name, flush=True)
