# SPDX-License-Identifier: BSD-3-Clause
"""pvbatch on several ranks: the same as on one. The first rank runs this, the others follow.

TestPluginParallel.py <number of ranks>: 1 writes what others compare with.
"""
import json
import sys

import numpy as np
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData, vtkStructuredGrid
from vtkmodules.vtkIOXML import vtkXMLStructuredGridWriter
from vtkmodules.vtkParallelCore import vtkMultiProcessController

import plugin_testing as t

ranks = vtkMultiProcessController.GetGlobalController().GetNumberOfProcesses()


def measured(proxy):
    """Area by ParaView's own integration over all ranks, and points of all ranks."""
    integral = simple.IntegrateVariables(Input=proxy)
    integral.UpdatePipeline()
    area = servermanager.Fetch(integral).GetCellData().GetArray("Area").GetValue(0)
    return {"points": proxy.GetDataInformation().GetNumberOfPoints(), "area": area}


def of_pieces(kind, attributes, array, pieces, extent=""):
    """The file that names the pieces of a data set, with the array of their points."""
    pieces = "\n".join(f"    <Piece {piece}/>" for piece in pieces)
    return f"""<VTKFile type="P{kind}" version="0.1" byte_order="LittleEndian">
  <P{kind} {extent}GhostLevel="0">
    <PPointData{attributes}>
      <PDataArray type="Float64" {array}/>
    </PPointData>
    <PPoints>
      <PDataArray type="Float64" Name="Points" NumberOfComponents="3"/>
    </PPoints>
{pieces}
  </P{kind}>
</VTKFile>
"""


PIECES = of_pieces(
    "PolyData",
    ' Normals="Normals"',
    'Name="Normals" NumberOfComponents="3"',
    ('Source="parallel_0.vtp"', 'Source="parallel_1.vtp"'),
)
LINES = of_pieces(
    "PolyData",
    ' TCoords="uv"',
    'Name="uv" NumberOfComponents="2"',
    ('Source="lines_0.vtp"', 'Source="lines_1.vtp"'),
)
GRID = of_pieces(
    "StructuredGrid",
    "",
    'Name="w" NumberOfComponents="1"',
    ('Extent="0 13 0 24 0 0" Source="grid_0.vts"', 'Extent="13 29 0 24 0 0" Source="grid_1.vts"'),
    'WholeExtent="0 29 0 24 0 0" ',
)


def write_pieces(path):
    points, normals = t.kitten()
    for piece in range(2):
        half = slice(piece * 2605, (piece + 1) * 2605)
        t.write(f"parallel_{piece}.vtp", t.polydata(points[half], normals[half]))
    with open(path, "w", encoding="ascii") as file:
        file.write(PIECES)


def wave(u, v):
    return np.stack((u, v, 0.2 * np.sin(3 * u) * np.cos(3 * v) + 0.01 * np.sin(40 * u + 30 * v)), -1)


def write_grid(name, begin, end):
    """Columns of a wave of 30 x 25 points."""
    v, u = np.meshgrid(np.linspace(0, 1, 25), np.linspace(0, 1, 30)[begin:end], indexing="ij")
    grid = vtkStructuredGrid()
    grid.SetExtent(begin, end - 1, 0, 24, 0, 0)
    grid.SetPoints(vtkPoints())
    grid.GetPoints().SetData(numpy_to_vtk(wave(u, v).reshape(-1, 3), deep=True))
    weights = numpy_to_vtk(np.where(u.ravel() < 0.5, 1e-7, 1e-5), deep=True)
    weights.SetName("w")
    grid.GetPointData().AddArray(weights)
    writer = vtkXMLStructuredGridWriter()
    writer.SetFileName(t.output(name))
    writer.SetInputData(grid)
    writer.SetDataModeToBinary()
    assert writer.Write()


def write_fairing_data():
    """Points in two files, each with a line through its own, and a grid in two pieces and in one."""
    for piece, count in enumerate((300, 200)):
        u = np.linspace(0, 1, count)
        v = (np.arange(count) * 0.618034 + 0.3 * piece) % 1
        data = vtkPolyData()
        data.SetPoints(vtkPoints())
        data.GetPoints().SetData(numpy_to_vtk(wave(u, v * (1 - piece) + 0.2), deep=True))
        lines = vtkCellArray()
        lines.InsertNextCell(count, list(range(count)))
        data.SetLines(lines)
        uv = numpy_to_vtk(np.stack((u, v), 1), deep=True)
        uv.SetName("uv")
        data.GetPointData().SetTCoords(uv)
        t.write(f"lines_{piece}.vtp", data)
    write_grid("grid_0.vts", 0, 14)
    write_grid("grid_1.vts", 13, 30)
    write_grid("grid.vts", 0, 30)
    for name, text in (("lines.pvtp", LINES), ("grid.pvts", GRID)):
        with open(t.output(name), "w", encoding="ascii") as file:
            file.write(text)


def fairing():
    """Points of the outputs of the fairing filters, by what was faired."""
    if ranks == 1:
        write_fairing_data()
    faired = t.faired()
    results = {}
    for name, proxy in faired.items():
        with t.Messages() as messages:
            proxy.UpdatePipeline()
        assert not messages.errors, (name, messages.errors)
        warned = [text for text in messages.warnings if "are fitted on the first of" in text]
        assert len(warned) == (ranks > 1), (name, messages.warnings)
        data = proxy.GetClientSideObject().GetOutputDataObject(0)
        data = data.GetBlock(0) if data.IsA("vtkMultiBlockDataSet") else data
        results[name] = vtk_to_numpy(data.GetPoints().GetData())
        count = proxy.GetDataInformation().GetNumberOfPoints()  # of all ranks
        assert count == len(results[name]) > 0, (name, count, len(results[name]))
    pieces = faired["grid"].Input
    own = pieces.GetClientSideObject().GetOutputDataObject(0).GetNumberOfPoints()
    assert (own == 750) == (ranks == 1), own

    # Blocks that are each a grid are no pieces of one: faired one by one, or on several ranks refused.
    whole = faired["grid of one file"].Input
    moved = simple.Transform(Input=whole)
    moved.Transform.Translate = [0.0, 0.0, 1.0]
    blocks = simple.FairingPIASurface(
        Input=simple.GroupDatasets(Input=[whole, moved]), Solver="Sparse direct")
    with t.Messages() as messages:
        blocks.UpdatePipeline()
    assert (blocks.GetDataInformation().GetNumberOfPoints() == 0) == (ranks > 1)
    assert bool(messages.errors) == (ranks > 1), messages.errors
    assert all("do not make up one grid" in text for text in messages.errors), messages.errors
    return results


def main(expected_ranks):
    assert ranks == expected_ranks, ranks
    # A file of two pieces: each rank reads its own.
    path = t.output("parallel.pvtp")
    if ranks == 1:
        write_pieces(path)
    cloud = simple.XMLPartitionedPolydataReader(FileName=[path])
    cloud.UpdatePipeline()
    own = cloud.GetClientSideObject().GetOutputDataObject(0).GetNumberOfPoints()
    assert own == (5210 if ranks == 1 else 2605), own

    results = {}
    with t.Messages() as messages:
        surface = simple.IPIASurfaceReconstruction(Input=cloud)
        surface.UpdatePipeline()
        results["surface"] = measured(surface)
        fitter = simple.IPIAImplicitFitter(Input=cloud)
        contour = simple.Contour(Input=fitter, ContourBy=["POINTS", "f"], Isosurfaces=[0.0])
        contour.UpdatePipeline()
        results["contour"] = measured(contour)
        oriented = simple.IPIAOrientedPointCloud(Input=cloud)
        results["oriented"] = {"points": 0}
        oriented.UpdatePipeline()
        results["oriented"]["points"] = oriented.GetDataInformation().GetNumberOfPoints()
        # Straight from a reader, in time, and again with other parameters.
        plain = simple.IPIASurfaceReconstruction(Input=cloud, GridSize=[40, 0, 0])
        plain.UpdatePipeline()
        results["plain"] = measured(plain)
        fitter.SampleDimensions = [60, 60, 60]
        contour.UpdatePipeline()
        results["coarse contour"] = measured(contour)
        fitter.GridSize = [30, 0, 0]
        contour.UpdatePipeline()
        results["coarse fit"] = measured(contour)
    assert not messages.errors, messages.errors
    gathered = [text for text in messages.warnings if "are fitted on the first of" in text]
    assert bool(gathered) == (ranks > 1), messages.warnings

    faired = fairing()
    if ranks == 1:
        np.savez(t.output("parallel_faired.npz"), **faired)
    else:
        single = np.load(t.output("parallel_faired.npz"))
        for name, points in faired.items():
            assert points.shape == single[name].shape, name
            found = np.abs(points - single[name]).max()
            print(f"{name}: {len(points)} points differ by {found:.3g}")
            assert found < 1e-12, (name, found)

    image = fitter.GetClientSideObject().GetOutputDataObject(0)
    f = vtk_to_numpy(image.GetPointData().GetArray("f"))
    if ranks == 1:
        np.save(t.output("parallel.npy"), f)
        with open(t.output("parallel.json"), "w", encoding="utf-8") as file:
            json.dump(results, file)
    else:
        found = np.abs(f - np.load(t.output("parallel.npy"))).max()
        print(f"f differs by {found:.3g}")
        # Points come in another order: rounding of sums.
        assert found < 1e-6, found
        with open(t.output("parallel.json"), encoding="utf-8") as file:
            single = json.load(file)
        for name, values in single.items():
            print(name, values, results[name])
            assert abs(values["points"] - results[name]["points"]) <= 5, name
            if "area" in values:
                assert abs(values["area"] / results[name]["area"] - 1) < 1e-6, name

    view = simple.CreateRenderView(ViewSize=[400, 400], OrientationAxesVisibility=0)
    simple.Show(surface, view)
    simple.ResetCamera(view)
    simple.SaveScreenshot(t.output(f"parallel{ranks}.png"), view, ImageResolution=[400, 400])
    if ranks > 1:
        found = t.difference(t.output(f"parallel{ranks}.png"), t.output("parallel1.png"))
        assert found < 10, found


main(int(sys.argv[1]))
