# SPDX-License-Identifier: BSD-3-Clause
"""The plugin was loaded when ParaView started, and its filters are there."""
from paraview import simple

plugins = simple.servermanager.vtkSMProxyManager.GetProxyManager().GetPluginManager()
local = plugins.GetLocalInformation()
loaded = [
    local.GetPluginName(i)
    for i in range(local.GetNumberOfPlugins())
    if local.GetPluginLoaded(i)
]
assert "IPIA" in loaded, loaded
for name in ("IPIAImplicitFitter", "IPIASurfaceReconstruction", "IPIAOrientedPointCloud"):
    assert hasattr(simple, name), name
    assert getattr(simple, name)(Input=simple.Sphere())
