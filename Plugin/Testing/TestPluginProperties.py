# SPDX-License-Identifier: BSD-3-Clause
"""Every property of every filter at its limits and beyond: a result, or an empty one and a message."""
import math
import sys

import numpy as np
from paraview import servermanager, simple

import plugin_testing as t

FILTERS = ("IPIAImplicitFitter", "IPIASurfaceReconstruction", "IPIAOrientedPointCloud")
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


def assign(proxy, name, value):
    """As a state file would, which no domain checks."""
    prop = proxy.SMProxy.GetProperty(name)
    if prop.IsA("vtkSMStringVectorProperty"):
        prop.SetElement(prop.GetNumberOfElements() - 1, value)
    else:
        for i in range(prop.GetNumberOfElements()):
            prop.SetElement(i, value)
    proxy.SMProxy.UpdateVTKObjects()


def finite(data):
    for i in range(data.GetPointData().GetNumberOfArrays()):
        array = data.GetPointData().GetArray(i)
        if array and array.GetName() in ("f", "Normals", "Gradient"):
            low, high = array.GetRange(-1) if array.GetNumberOfComponents() > 1 else array.GetRange()
            if not (math.isfinite(low) and math.isfinite(high)):
                return False
    return True


def check(make, name, value, source, found):
    proxy = make(Input=source)
    for other, given in COMPANIONS.get(name, {}).items():
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
    elif data.IsA("vtkImageData") and data.GetNumberOfPoints() == 0:
        wrong = "empty, and no message"
    simple.Delete(proxy)
    return f"{what}: {wrong}" if wrong else None


def test_every_property():
    found, failures = {}, []
    source = t.producer(cloud())
    manager = servermanager.ProxyManager()
    for filter_name in FILTERS:
        prototype = manager.GetPrototypeProxy("filters", filter_name)
        iterator = prototype.NewPropertyIterator()
        names = []
        while not iterator.IsAtEnd():
            if not iterator.GetProperty().IsA("vtkSMInputProperty"):
                names.append(iterator.GetKey())
            iterator.Next()
        assert len(names) >= 6, names
        for name in names:
            if len(sys.argv) > 2 and sys.argv[2] != name:
                continue
            for value in values_of(prototype.GetProperty(name)):
                wrong = check(getattr(simple, filter_name), name, value, source, found)
                if wrong:
                    failures.append(wrong)
    for (name, value), text in found.items():
        print(f"{name} = {value}: {text.strip().splitlines()[-1]}")
    for key, word in REFUSED.items():
        if len(sys.argv) < 3 or sys.argv[2] == key[0]:
            if word not in found.get(key, ""):
                failures.append(f"{key}: '{word}' is not in the message '{found.get(key)}'")
    assert not failures, "\n".join(failures)


if __name__ == "__main__":
    t.run(globals())
