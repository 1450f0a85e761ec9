# SPDX-License-Identifier: BSD-3-Clause
"""A client of pvserver: results and pictures as in a session of its own.

TestPluginServer.py <port> <ranks of the server>
"""
import json
import sys

import numpy as np
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

import plugin_testing as t

port, ranks = int(sys.argv[1]), int(sys.argv[2])
simple.Connect("127.0.0.1", port)  # "localhost" may have no entry in /etc/hosts
assert servermanager.ActiveConnection.IsRemote()
assert servermanager.ActiveConnection.GetNumberOfDataPartitions() == ranks

plugins = servermanager.vtkSMProxyManager.GetProxyManager().GetPluginManager()
remote = plugins.GetRemoteInformation(servermanager.ActiveConnection.Session)
loaded = [
    remote.GetPluginName(i)
    for i in range(remote.GetNumberOfPlugins())
    if remote.GetPluginLoaded(i)
]
assert "IPIA" in loaded, loaded

cloud = simple.XMLPartitionedPolydataReader(FileName=[t.output("parallel.pvtp")])
cloud.UpdatePipeline()
surface = simple.IPIASurfaceReconstruction(registrationName="Surface", Input=cloud)
fitter = simple.IPIAImplicitFitter(Input=cloud)
contour = simple.Contour(Input=fitter, ContourBy=["POINTS", "f"], Isosurfaces=[0.0])
with open(t.output("parallel.json"), encoding="utf-8") as file:
    expected = json.load(file)
for name, proxy in (("surface", surface), ("contour", contour)):
    integral = simple.IntegrateVariables(Input=proxy)
    integral.UpdatePipeline()
    area = servermanager.Fetch(integral).GetCellData().GetArray("Area").GetValue(0)
    print(name, area, expected[name])
    assert abs(area / expected[name]["area"] - 1) < 1e-6
    found = proxy.GetDataInformation().GetNumberOfPoints()
    assert abs(found - expected[name]["points"]) <= 5, found
assert surface.PointData.GetNumberOfArrays() == 1 and surface.PointData[0].Name == "Normals"

# The fairing filters: all points of what the client fetches are those of a session of one rank.
single = np.load(t.output("parallel_faired.npz"))
for name, proxy in t.faired().items():
    proxy.UpdatePipeline()
    data = servermanager.Fetch(proxy)
    data = data.GetBlock(0) if data.IsA("vtkMultiBlockDataSet") else data
    points = vtk_to_numpy(data.GetPoints().GetData())
    assert points.shape == single[name].shape, (name, points.shape, single[name].shape)
    found = np.abs(points - single[name]).max()
    print(f"{name}: {len(points)} points differ by {found:.3g}")
    assert found < 1e-12, (name, found)

view = simple.CreateRenderView(ViewSize=[400, 400], OrientationAxesVisibility=0)
simple.Show(surface, view)
simple.ResetCamera(view)
shot = t.output(f"server{ranks}.png")
simple.SaveScreenshot(shot, view, ImageResolution=[400, 400])
found = t.difference(shot, t.output("parallel1.png"))
print(f"pictures differ by {found}")
assert found < 10

# A state of this session, loaded into it again.
state = t.output(f"server{ranks}.pvsm")
simple.SaveState(state)
for source in list(simple.GetSources().values()):
    simple.Delete(source)
simple.LoadState(state)
again = simple.FindSource("Surface")
again.UpdatePipeline()
assert abs(again.GetDataInformation().GetNumberOfPoints() - expected["surface"]["points"]) <= 5
