# SPDX-License-Identifier: BSD-3-Clause
"""pvbatch on several ranks: the same as on one. The first rank runs this, the others follow.

TestPluginParallel.py <number of ranks>: 1 writes what others compare with.
"""
import json
import sys

import numpy as np
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkParallelCore import vtkMultiProcessController

import plugin_testing as t

ranks = vtkMultiProcessController.GetGlobalController().GetNumberOfProcesses()


def measured(proxy):
    """Area by ParaView's own integration over all ranks, and points of all ranks."""
    integral = simple.IntegrateVariables(Input=proxy)
    integral.UpdatePipeline()
    area = servermanager.Fetch(integral).GetCellData().GetArray("Area").GetValue(0)
    return {"points": proxy.GetDataInformation().GetNumberOfPoints(), "area": area}


PIECES = """<VTKFile type="PPolyData" version="0.1" byte_order="LittleEndian">
  <PPolyData GhostLevel="0">
    <PPointData Normals="Normals">
      <PDataArray type="Float64" Name="Normals" NumberOfComponents="3"/>
    </PPointData>
    <PPoints>
      <PDataArray type="Float64" Name="Points" NumberOfComponents="3"/>
    </PPoints>
    <Piece Source="parallel_0.vtp"/>
    <Piece Source="parallel_1.vtp"/>
  </PPolyData>
</VTKFile>
"""


def write_pieces(path):
    points, normals = t.kitten()
    for piece in range(2):
        half = slice(piece * 2605, (piece + 1) * 2605)
        t.write(f"parallel_{piece}.vtp", t.polydata(points[half], normals[half]))
    with open(path, "w", encoding="ascii") as file:
        file.write(PIECES)


def main(expected_ranks):
    assert ranks == expected_ranks, ranks
    # A file of two pieces: each rank reads its own.
    path = t.output("parallel.pvtp")
    if ranks == 1:
        write_pieces(path)
    cloud = simple.XMLPartitionedPolydataReader(FileName=[path])
    cloud.UpdatePipeline()
    own = cloud.GetClientSideObject().GetOutputDataObject(0).GetNumberOfPoints()
    assert own == 5210 // ranks, own

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
