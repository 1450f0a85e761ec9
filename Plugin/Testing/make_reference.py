# SPDX-License-Identifier: BSD-3-Clause
"""What the package ipia gives on the installed VTK, for TestPluginFilters.py to compare with.

make_reference.py <kitten.xyz> <output folder>
"""
import os
import sys

import numpy as np
from ipia import vtkIPIAImplicitFitter, vtkIPIASurfaceReconstruction
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData

columns = np.loadtxt(sys.argv[1])
points = vtkPoints()
points.SetData(numpy_to_vtk(np.ascontiguousarray(columns[:, :3]), deep=True))
normals = numpy_to_vtk(np.ascontiguousarray(columns[:, 3:6]), deep=True)
normals.SetName("Normals")
cloud = vtkPolyData()
cloud.SetPoints(points)
cloud.GetPointData().SetNormals(normals)


def array(data, name):
    return vtk_to_numpy(data.GetPointData().GetArray(name))


fitter = vtkIPIAImplicitFitter()
fitter.SetInputData(cloud)
fitter.SetOutputScalarTypeToDouble()
fitter.GenerateGradientOn()
fitter.Update()
image = fitter.GetOutput()
reconstruction = vtkIPIASurfaceReconstruction()
reconstruction.SetInputData(cloud)
reconstruction.SetOutputPointsPrecision(1)
reconstruction.Update()
surface = reconstruction.GetOutput()
np.savez(
    os.path.join(sys.argv[2], "reference.npz"),
    dimensions=image.GetDimensions(),
    origin=image.GetOrigin(),
    spacing=image.GetSpacing(),
    f=array(image, "f"),
    gradient=array(image, "Gradient"),
    distance=array(fitter.GetOutputDataObject(1), "Distance"),
    coefficient=array(fitter.GetOutputDataObject(2), "Coefficient"),
    vertices=vtk_to_numpy(surface.GetPoints().GetData()),
    triangles=vtk_to_numpy(surface.GetPolys().GetConnectivityArray()),
)
