# SPDX-License-Identifier: BSD-3-Clause
"""The plugin was loaded when ParaView started, and its filters are there; what it was installed as."""
import os
import pathlib

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

# Nothing else: ParaView needs none of what the plugin is linked from.
installed = {os.path.relpath(path, os.environ["IPIA_PLUGINS"])
             for path in pathlib.Path(os.environ["IPIA_PREFIX"]).rglob("*") if not path.is_dir()}
assert installed == {
    "ipia.plugins.xml",
    "IPIA/IPIA.so",
    "IPIA/libvtkFiltersIPIA.so",
    "IPIA/libvtkFiltersIPIAParaView.so",
}, installed
