# SPDX-License-Identifier: BSD-3-Clause
"""Every property of every filter at its limits and beyond: a result, or an empty one and a message."""
import math
import sys

import numpy as np
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

import plugin_testing as t
from TestPluginFairing import named, results, uneven_circle, uneven_wave

FILTERS = ("IPIAImplicitFitter", "IPIASurfaceReconstruction", "IPIAOrientedPointCloud")
FAIRING = ("FairingPIACurve", "FairingPIASurface")
LARGEST_INT = 2**31 - 1
INTS = (-LARGEST_INT - 1, -1, 0, 1, 2, 3, 4, 5, 11, 21, LARGEST_INT)
DOUBLES = (-1e308, -1.0, -1e-300, 0.0, 1e-300, 1e-12, 1.0, 1e12, 1e308, math.inf, -math.inf, math.nan)

# What a value needs beside it to be used at all.
SINGLE_LEVEL = {"NumberOfLevels": 1, "NormalConstraint": "Two-sided offset"}
PROGRESSIVE = dict(SINGLE_LEVEL, Solver="Progressive iteration")
BOX = {"UsePointBounds": 0, "ModelBoundsOrigin": [-3] * 3, "ModelBoundsLength": [6] * 3}
COMPANIONS = {
    "OffsetDistance": SINGLE_LEVEL,
    "OffsetValue": SINGLE_LEVEL,
    "InwardOffsetDistance": SINGLE_LEVEL,
    "InwardOffsetValue": SINGLE_LEVEL,
    "Solver": SINGLE_LEVEL,
    "StepSize": PROGRESSIVE,
    "BasisType": PROGRESSIVE,
    "WeightStepSize": dict(PROGRESSIVE, BasisType="Uniform rational"),
    "OscillationWeight": PROGRESSIVE,
    "OscillationStep": dict(PROGRESSIVE, OscillationWeight=1e-3),
    "MaximumNumberOfIterations": {"Tolerance": 1e-3},
    "ModelBoundsOrigin": BOX,
    "ModelBoundsLength": BOX,
    "NormalX": {"NormalSource": "Three arrays"},
    "NormalY": {"NormalSource": "Three arrays"},
    "NormalZ": {"NormalSource": "Three arrays"},
}
# Values that the filters refuse, each by a message that names the property's matter.
REFUSED = {
    ("GridSize", -1): "GridSize",
    ("GridSize", 1): "GridSize",
    ("GridSize", 3): "GridSize",
    ("GridSize", LARGEST_INT): "memory",
    ("SampleDimensions", 1): "SampleDimensions",
    ("SampleDimensions", LARGEST_INT): "memory",
    ("ModelBoundsLength", 0.0): "ModelBounds",
    ("ModelBoundsLength", -1.0): "ModelBounds",
    ("ModelBoundsOrigin", 1e12): "ModelBounds",
    ("StepSize", 1.0): "StepSize",
}


# The fairing filters.
CHOSEN = {"AutomaticFairing": "Second difference"}
FAIRING_COMPANIONS = {
    "AutomaticShare": CHOSEN,
    "AutomaticFairingWeight": CHOSEN,
    "MaximumNumberOfIterations": {"Tolerance": 1e-3},
    "Parameters": {"Parametrization": "Given"},
    "MovablePoints": {"UseMovablePoints": 1},
}
FAIRING_REFUSED = {("SampleDimensions", LARGEST_INT): "memory", ("NumberOfControlPoints", LARGEST_INT): "NumberOfControlPoints"}
for outside in (-1.0, 1e12, math.inf):
    for weight in ("FairingWeight", "AutomaticFairingWeight", "AutomaticShare"):
        FAIRING_REFUSED[(weight, outside)] = weight
for negative in (-1.0, -1e-300, -math.inf):
    FAIRING_REFUSED[("Tolerance", negative)] = "Tolerance"
    FAIRING_REFUSED[("StepSize", negative)] = "StepSize"
FAIRING_REFUSED.update({
    ("NumberOfControlPoints", 1): "NumberOfControlPoints",
    ("NumberOfControlPoints", 3): "NumberOfControlPoints",
    ("Degree", 1): "DerivativeOrder",
    ("Parametrization", 3): "Parametrization is Given",
    ("Weights", "zz"): "zz",
    ("Parameters", "zz"): "parameter",
    ("Parameters", "None"): "Parametrization is Given",
    ("ControlPointWeights", "zz"): '"zz"',
    ("StepSize", 1e12): "diverged",
})


def cloud():
    points, normals = t.sphere(400)
    return t.polydata(
        points, normals, nx=normals[:, 0], ny=normals[:, 1], nz=normals[:, 2],
        Weight=np.ones(len(points)), zz=np.linspace(-1, np.nan, len(points)))


def values_of(prop):
    """What a property is set to, one value (of every element) each."""
    if prop.IsA("vtkSMIntVectorProperty"):
        domain = prop.FindDomain("vtkSMEnumerationDomain")
        if domain:
            entries = [domain.GetEntryValue(i) for i in range(domain.GetNumberOfEntries())]
            return sorted(set(entries) | set(INTS))
        return INTS
    if prop.IsA("vtkSMDoubleVectorProperty"):
        return DOUBLES
    return ("Normals", "Weight", "zz", "nx", "no such array", "None", "")


def fairing_data(name):
    """What a fairing filter takes, and its control points, with arrays to choose."""
    data = uneven_circle(60) if name == "FairingPIACurve" else uneven_wave(12)
    first = getattr(simple, name)(Input=t.producer(data))
    controls = results(first)[1]
    copy = controls.NewInstance()
    copy.DeepCopy(controls)
    simple.Delete(first)
    for some in (data, copy):
        count = some.GetNumberOfPoints()
        parts = [("Weight", np.linspace(0, 1e-3, count)), ("nx", np.linspace(-1, 1, count)),
                 ("zz", np.linspace(0.5, np.nan, count)), ("Normals", np.ones((count, 3)))]
        for label, values in parts:
            some.GetPointData().AddArray(named(values, label))
    return data, copy


def assign(proxy, name, value):
    """As a state file would, which no domain checks."""
    prop = proxy.SMProxy.GetProperty(name)
    if prop.IsA("vtkSMStringVectorProperty"):
        prop.SetElement(prop.GetNumberOfElements() - 1, value)
    else:
        for i in range(prop.GetNumberOfElements()):
            prop.SetElement(i, value)
    proxy.SMProxy.UpdateVTKObjects()


FINITE = ("f", "Normals", "Gradient", "Curvature", "Torsion", "MeanCurvature", "GaussCurvature", "FitError")


def finite(data):
    for i in range(data.GetPointData().GetNumberOfArrays()):
        array = data.GetPointData().GetArray(i)
        if array and array.GetName() in FINITE:
            low, high = array.GetRange(-1) if array.GetNumberOfComponents() > 1 else array.GetRange()
            if not (math.isfinite(low) and math.isfinite(high)):
                return False
    return True


def places(data):
    return vtk_to_numpy(data.GetPoints().GetData()) if data.GetNumberOfPoints() else np.zeros((0, 3))


def check(make, name, value, source, found, companions, **inputs):
    proxy = make(Input=source, **inputs)
    for other, given in companions.get(name, {}).items():
        if other != name and hasattr(proxy, other):
            setattr(proxy, other, given)
    what = f"{proxy.GetXMLName()}.{name} = {value}"
    print(what, flush=True)  # named where something crashes or hangs
    with t.Messages() as messages:
        assign(proxy, name, value)
        proxy.UpdatePipeline()
    data = proxy.GetClientSideObject().GetOutputDataObject(0)
    wrong = None
    if messages.errors:
        found[(name, value)] = messages.errors[0]
        if len(messages.errors) > 1:
            wrong = f"{len(messages.errors)} messages: {messages.errors}"
        elif data.GetNumberOfPoints() > 0:
            wrong = f"a message and a result: {messages.errors[0]}"
    elif value != "zz" and not finite(data):  # no surface is a result: f can be positive everywhere
        wrong = "not finite, and no message"
    elif proxy.GetXMLName() in FAIRING and not np.isfinite(places(data)).all():
        wrong = "points that are not finite, and no message"
    elif (data.IsA("vtkImageData") or proxy.GetXMLName() in FAIRING) and data.GetNumberOfPoints() == 0:
        wrong = "empty, and no message"
    simple.Delete(proxy)
    return f"{what}: {wrong}" if wrong else None


def names_of(filter_name):
    prototype = servermanager.ProxyManager().GetPrototypeProxy("filters", filter_name)
    iterator = prototype.NewPropertyIterator()
    names = {}
    while not iterator.IsAtEnd():
        if not iterator.GetProperty().IsA("vtkSMInputProperty"):
            names[iterator.GetKey()] = values_of(iterator.GetProperty())
        iterator.Next()
    assert len(names) >= 6, names
    return names


def every_property(filters, data, companions, refused):
    """The message of each value that is refused, which is told to be so by `refused`."""
    failures = []
    found = {}
    for filter_name in filters:
        source, inputs = data(filter_name)
        for name, values in names_of(filter_name).items():
            if len(sys.argv) > 2 and sys.argv[2] != name:
                continue
            for value in values:
                wrong = check(
                    getattr(simple, filter_name), name, value, source, found, companions,
                    **inputs(name))
                if wrong:
                    failures.append(wrong)
        if filter_name in FAIRING:  # each by itself
            failures += missing(found, refused, filter_name)
            found = {}
    if found:
        failures += missing(found, refused, "filters")
    assert not failures, "\n".join(failures)


def missing(found, refused, what):
    for (name, value), text in found.items():
        print(f"{name} = {value}: {text.strip().splitlines()[-1]}")
    return [
        f"{what}, {key}: '{word}' is not in the message '{found.get(key)}'"
        for key, word in refused.items()
        if (len(sys.argv) < 3 or sys.argv[2] == key[0]) and word not in found.get(key, "")
    ]


def test_every_property():
    source = t.producer(cloud())
    every_property(FILTERS, lambda _: (source, lambda name: {}), COMPANIONS, REFUSED)


def test_every_property_of_fairing():
    def data(filter_name):
        points, controls = fairing_data(filter_name)
        control_source = t.producer(controls)
        later = ("ControlPointWeights", "MovablePoints", "UseMovablePoints")
        return t.producer(points), lambda name: {"ControlPoints": control_source} if name in later else {}

    every_property(FAIRING, data, FAIRING_COMPANIONS, FAIRING_REFUSED)


def test_numbers_of_control_points_of_scattered_points():
    data, _ = fairing_data("FairingPIASurface")
    uv = vtk_to_numpy(data.GetPoints().GetData())[:, :2]
    data.GetPointData().SetTCoords(named(uv, "uv"))
    source = t.producer(data)
    companions = {"NumberOfControlPoints": {"Parametrization": "Given"}}
    found = {}
    for value in INTS:
        wrong = check(simple.FairingPIASurface, "NumberOfControlPoints", value, source, found, companions)
        assert not wrong, wrong
    refused = sorted(value for _, value in found)
    assert refused == [-LARGEST_INT - 1, -1, 1, 2, 3, LARGEST_INT], found
    assert all("NumberOfControlPoints" in text for text in found.values()), found


if __name__ == "__main__":
    t.run(globals())
