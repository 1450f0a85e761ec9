# SPDX-License-Identifier: BSD-3-Clause
"""The trace of TestPluginGui.py, run again: the filter as it was in the program."""
import json

from paraview import simple

import plugin_testing as t

with open(t.output("gui/trace.py"), encoding="utf-8") as file:
    trace = file.read()
assert "IPIASurfaceReconstruction(" in trace and "GridSize = [24, 0, 0]" in trace, trace
with t.Messages() as messages:
    exec(compile(trace, "trace.py", "exec"), {"__name__": "trace"})
    source = simple.FindSource("IPIASurfaceReconstruction1")
    source.UpdatePipeline()
assert not messages.errors, messages.errors
with open(t.output("gui/coarse.json"), encoding="utf-8") as file:
    expected = json.load(file)
assert list(source.GridSize) == expected["GridSize"]
assert source.FairingWeight == expected["FairingWeight"]
assert source.GetDataInformation().GetNumberOfPoints() == expected["points"]
