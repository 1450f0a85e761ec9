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


def main(expected_ranks):
    assert ranks == expected_ranks, ranks
    # Its points are spread over the ranks.
    path = t.output("parallel.vtp")
    if expected_ranks == 1:
        t.write("parallel.vtp", t.polydata(*t.kitten()))
    cloud = simple.XMLPolyDataReader(FileName=[path])
    spread = simple.ExtractSurface(Input=simple.RedistributeDataSet(Input=cloud))
    spread.UpdatePipeline()
    own = spread.GetClientSideObject().GetOutputDataObject(0).GetNumberOfPoints()
    assert 0 < own < 5210 or ranks == 1, "the points are not spread"

    results = {}
    with t.Messages() as messages:
        surface = simple.IPIASurfaceReconstruction(Input=spread)
        surface.UpdatePipeline()
        results["surface"] = measured(surface)
        fitter = simple.IPIAImplicitFitter(Input=spread)
        contour = simple.Contour(Input=fitter, ContourBy=["POINTS", "f"], Isosurfaces=[0.0])
        contour.UpdatePipeline()
        results["contour"] = measured(contour)
        oriented = simple.IPIAOrientedPointCloud(Input=spread)
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
