# SPDX-License-Identifier: BSD-3-Clause
"""The fairing filters by their proxies."""
import numpy as np
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData, vtkStructuredGrid

import plugin_testing as t

NAMES = ("FairingPIACurve", "FairingPIASurface")


def points_of(x):
    points = vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(x, dtype=float), deep=True))
    return points


def uneven_circle(count=200):
    angle = 2 * np.pi * np.arange(count + 1) / count
    radius = t.RADIUS + 0.01 * np.random.default_rng(1).normal(size=count + 1)
    radius[-1] = radius[0]
    line = vtkPolyData()
    line.SetPoints(points_of(np.stack((radius * np.cos(angle), radius * np.sin(angle), 0 * angle), 1)))
    cells = vtkCellArray()
    cells.InsertNextCell(count + 1, list(range(count + 1)))
    line.SetLines(cells)
    return line


def uneven_wave(size=30):
    u, v = np.meshgrid(np.linspace(0, 1, size), np.linspace(0, 1, size))
    z = 0.2 * np.sin(3 * u) * np.cos(3 * v) + 0.005 * np.random.default_rng(1).normal(size=u.shape)
    grid = vtkStructuredGrid()
    grid.SetDimensions(size, size, 1)
    grid.SetPoints(points_of(np.stack((u.ravel(), v.ravel(), z.ravel()), 1)))
    return grid


def results(proxy):
    proxy.UpdatePipeline()
    source = proxy.GetClientSideObject()
    return [source.GetOutputDataObject(port) for port in range(3)]


def value(data, name):
    return data.GetFieldData().GetArray(name).GetValue(0)


def test_every_property_is_documented():
    manager = servermanager.ProxyManager()
    for name in NAMES:
        proxy = manager.GetPrototypeProxy("filters", name)
        assert proxy.GetHints().FindNestedElementByName("ShowInMenu").GetAttribute("category") == "IPIA"
        iterator = proxy.NewPropertyIterator()
        while not iterator.IsAtEnd():
            documentation = iterator.GetProperty().GetDocumentation()
            text = documentation and documentation.GetDescription()
            assert text, iterator.GetKey()
            assert iterator.GetKey() == "Input" or "Default:" in text, iterator.GetKey()
            iterator.Next()


def test_curve_gets_fairer():
    source = t.producer(uneven_circle())
    energies = []
    for weight in (1e-8, 1e-6):
        curve = simple.FairingPIACurve(Input=source, FairingWeight=weight, Solver="Sparse direct")
        with t.Messages() as messages:
            fair, controls, data = results(curve)
        assert not messages.errors, messages.errors
        assert controls.GetPointData().GetArray("FairingWeight") and data.GetNumberOfPoints() == 201
        radius = np.linalg.norm(vtk_to_numpy(fair.GetPoints().GetData()), axis=1)
        assert np.abs(radius - t.RADIUS).max() < 0.05, np.abs(radius - t.RADIUS).max()
        energies.append(value(fair, "FairingEnergy"))
    assert energies[1] < energies[0], energies


def test_surface_gets_fairer():
    source = t.producer(uneven_wave())
    energies = []
    for weight in (1e-8, 1e-6):
        surface = simple.FairingPIASurface(Input=source, FairingWeight=weight, Solver="Sparse direct")
        with t.Messages() as messages:
            fair, _, _ = results(surface)
        assert not messages.errors, messages.errors
        assert fair.GetNumberOfPolys() > 0 and fair.GetPointData().GetArray("MeanCurvature")
        energies.append(value(fair, "FairingEnergy"))
    assert energies[1] < energies[0], energies


def test_refusals_reach_the_messages():
    curve = simple.FairingPIACurve(Input=t.producer(uneven_circle()), FairingWeight=2.0)
    with t.Messages() as messages:
        fair, _, _ = results(curve)
    assert len(messages.errors) == 1 and fair.GetNumberOfPoints() == 0, messages.errors


if __name__ == "__main__":
    t.run(globals())
