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


def named(values, name):
    array = numpy_to_vtk(np.ascontiguousarray(values, dtype=float), deep=True)
    array.SetName(name)
    return array


def controls_of(proxy):
    return vtk_to_numpy(results(proxy)[1].GetPoints().GetData()).copy()


def test_a_later_round_takes_arrays_of_the_control_points():
    for make, data in ((simple.FairingPIACurve, uneven_circle()), (simple.FairingPIASurface, uneven_wave())):
        source = t.producer(data)
        first = make(Input=source, Solver="Sparse direct")
        before = results(first)[1]
        points = vtk_to_numpy(before.GetPoints().GetData()).copy()
        again = make(Input=source, Solver="Sparse direct",
                     ControlPoints=servermanager.OutputPort(first, 1))
        assert np.abs(controls_of(again) - points).max() < 1e-9
        # Edited, as by Calculator.
        edited = before.NewInstance()
        edited.DeepCopy(before)
        movable = np.arange(len(points)) < len(points) // 4
        edited.GetPointData().SetScalars(named(movable, "movable"))
        edited.GetPointData().AddArray(named(np.full(len(points), 1e-3), "fair"))
        later = make(Input=source, ControlPoints=t.producer(edited), Solver="Sparse direct",
                     ControlPointWeights="fair")
        everywhere = np.abs(controls_of(later) - points).max(axis=1)
        assert (everywhere > 1e-6).mean() > 0.9, everywhere
        later.MovablePoints, later.UseMovablePoints = "movable", 1
        moved = np.abs(controls_of(later) - points).max(axis=1)
        assert moved[~movable].max() == 0 and moved[movable].max() > 1e-6, moved
        # Without them Fairing Weight holds, as without such an array.
        later.UseMovablePoints, later.UseControlPointWeights = 0, 0
        assert np.abs(controls_of(later) - points).max() < 1e-9
        later.UseControlPointWeights = 1
        assert np.abs(controls_of(later) - points).max() > 1e-6
        later.ControlPointWeights = "None"
        assert np.abs(controls_of(later) - points).max() < 1e-9


def test_given_parameters():
    line = uneven_circle()
    u = np.linspace(0, 1, line.GetNumberOfPoints())
    line.GetPointData().AddArray(named(u**1.1, "t"))
    curve = simple.FairingPIACurve(Input=t.producer(line), Parametrization="Given", Parameters="t")
    with t.Messages() as messages:
        _, _, data = results(curve)
    assert not messages.errors, messages.errors
    found = vtk_to_numpy(data.GetPointData().GetArray("Parameter"))
    assert np.abs(found - u[: len(found)] ** 1.1).max() < 1e-12
    curve.Parameters = "None"
    with t.Messages() as messages:
        results(curve)
    assert len(messages.errors) == 1 and "no array of parameters" in messages.errors[0], messages.errors

    grid = uneven_wave()
    uv = vtk_to_numpy(grid.GetPoints().GetData())[:, :2]
    grid.GetPointData().AddArray(named(uv, "uv"))
    grid.GetPointData().SetTCoords(named(uv[:, ::-1], "vu"))
    surface = simple.FairingPIASurface(Input=t.producer(grid), Parametrization="Given", Solver="Sparse direct")
    for choice, expected in (("Active texture coordinates", uv[:, ::-1]), ("uv", uv)):
        surface.Parameters = choice
        with t.Messages() as messages:
            _, _, data = results(surface)
        assert not messages.errors, messages.errors
        assert np.abs(vtk_to_numpy(data.GetPointData().GetArray("Parameter")) - expected).max() < 1e-12


def test_refusals_reach_the_messages():
    curve = simple.FairingPIACurve(Input=t.producer(uneven_circle()), FairingWeight=2.0)
    with t.Messages() as messages:
        fair, _, _ = results(curve)
    assert len(messages.errors) == 1 and fair.GetNumberOfPoints() == 0, messages.errors


if __name__ == "__main__":
    t.run(globals())
