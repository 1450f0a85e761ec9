# SPDX-License-Identifier: BSD-3-Clause
"""The program paraview as a person uses it: open a cloud, apply the filter, change it, undo.

TestPluginGui.py [folder]: writes the screenshots of Documentation/ParaView.md to the folder, too.

ParaView's own test player (--test-script) activates menus, buttons and fields by their names. Between
these the Python shell of the same program runs a short script, which notes what the session holds and
takes a picture of the screen; a trace runs along and is left for TestPluginTrace.py.
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile

import numpy as np

OUTPUT = os.environ["IPIA_TEST_OUTPUT"]
FOLDER = os.path.join(OUTPUT, "gui")
WINDOW = "pqClientMainWindow"
PANEL = WINDOW + "/propertiesDock/propertiesPanel"
PROPERTIES = (PANEL + "/scrollArea/qt_scrollarea_viewport/scrollAreaWidgetContents/PropertiesFrame"
              "/ProxyPanel")
SHELL = WINDOW + "/pythonShellDock/pythonShell"
SIZE = (1400, 1000)
ORANGE = (232, 115, 26)  # of Plugin/IPIA/Icons
MENU_PART = "560x450+190+0"
PANEL_WIDTH = 430  # pixels, that every property can be read

events = []


def event(widget, command, arguments=""):
    events.append(f'<pqevent object="{widget}" command="{command}" arguments="{arguments}"/>')


def path(name):
    return os.path.join(FOLDER, name)


def run_in_shell(name, code):
    with open(path(name), "w", encoding="utf-8") as file:
        file.write(code)
    event(SHELL + "/runScriptButton", "activate")
    event(SHELL + "/PythonShellRunScriptDialog", "filesSelected", path(name))


def apply():
    event(PANEL + "/Accept", "activate")


def change():
    event(PROPERTIES + "/GridSize/LineEdit0", "set_string", "24")
    event(PROPERTIES + "/FairingWeight/DoubleLineEdit0", "set_string", "1")
    apply()


NOTE = """
import json, subprocess
from paraview import simple
simple.RenderAllViews()
source = simple.GetActiveSource()
noted = {{
    "type": source.GetXMLName(),
    "points": source.GetDataInformation().GetNumberOfPoints(),
    "cells": source.GetDataInformation().GetNumberOfCells(),
}}
for name in ("GridSize", "FairingWeight", "UsePointBounds", "Normals", "UseControlPointWeights"):
    if hasattr(source, name):
        value = getattr(source, name)
        noted[name] = list(value) if hasattr(value, "__len__") else value
with open({noted!r}, "w") as file:
    json.dump(noted, file)
subprocess.run(["import", "-silent", "-window", "root", {picture!r}])
"""


def note(name):
    # Two steps: what the first has drawn is on the screen when the second looks.
    run_in_shell(f"draw_{name}.py", "from paraview import simple\nsimple.RenderAllViews()\n")
    run_in_shell(f"note_{name}.py",
                 NOTE.format(noted=path(f"{name}.json"), picture=path(f"{name}.png")))


# The shell waits for menus to close: pictures are taken meanwhile, and the player pauses.
MENU = f"""
import subprocess
subprocess.Popen(
    ["sh", "-c",
     'for i in 1 2 3 4 5 6 7 8 9; do sleep 1; import -silent -window root "$0/menu$i.png"; done',
     {FOLDER!r}])
"""
LATER_ROUND = """
from paraview import servermanager, simple
data = simple.Ellipse(Resolution=100)
first = simple.FairingPIACurve(Input=data)
first.UpdatePipeline()
again = simple.FairingPIACurve(Input=data, ControlPoints=servermanager.OutputPort(first, 1))
simple.Show(again)
simple.SetActiveSource(again)
"""
ARRANGE = f"""
import subprocess
def xdotool(*words):
    return subprocess.run(["xdotool", *map(str, words)], capture_output=True, text=True).stdout
(window,) = xdotool("search", "--onlyvisible", "--name", "^ParaView 5").split()
xdotool("windowmove", window, 0, 0, "windowsize", "--sync", window, {SIZE[0]}, {SIZE[1]})
"""
START_TRACE = """
from paraview import smtrace
smtrace.start_trace()
"""
STOP_TRACE = f"""
from paraview import smtrace
with open({path("trace.py")!r}, "w") as file:
    file.write(smtrace.stop_trace())
"""


def write_events(scan):
    run_in_shell("arrange.py", ARRANGE)
    run_in_shell("start_trace.py", START_TRACE)
    event(WINDOW + "/menubar/menu_File", "activate", "actionFileOpen")
    event(WINDOW + "/FileOpenDialog", "filesSelected", scan)
    apply()
    # A file of points without cells shows nothing as a surface.
    event(WINDOW + "/representationToolbar/displayRepresentation/comboBox", "set_string", "Point Gaussian")
    note("cloud")
    run_in_shell("menu.py", MENU)
    event(WINDOW + "/menubar", "activate", "menuFilters")
    event(WINDOW + "/menubar/menuFilters", "activate", "IPIA")
    event(WINDOW, "pause", "5000")
    event(WINDOW + "/menubar/menuFilters/IPIA", "activate", "IPIASurfaceReconstruction")
    note("panel")
    apply()
    note("surface")
    # The shell empties the stack of what can be undone: not between a change and its undoing.
    change()
    event(WINDOW + "/menubar/menu_Edit", "activate", "actionEditUndo")
    note("undone")
    event(PROPERTIES + "/UsePointBounds/CheckBox", "set_boolean", "false")
    note("box")
    event(PROPERTIES + "/UsePointBounds/CheckBox", "set_boolean", "true")
    apply()
    event(PANEL + "/SearchBox/AdvancedButton", "set_boolean", "true")
    note("advanced")
    event(PANEL + "/SearchBox/AdvancedButton", "set_boolean", "false")
    change()
    event(WINDOW + "/menubar/menu_Edit", "activate", "actionEditUndo")
    event(WINDOW + "/menubar/menu_Edit", "activate", "actionEditRedo")
    note("coarse")
    run_in_shell("stop_trace.py", STOP_TRACE)
    # A refusal: the message window comes by itself.
    event(PROPERTIES + "/GridSize/LineEdit0", "set_string", "2")
    apply()
    note("refused")
    # A later round of fairing, with the weights of the one before and without.
    run_in_shell("later_round.py", LATER_ROUND)
    event(PANEL + "/SearchBox/AdvancedButton", "set_boolean", "true")
    apply()
    note("weights")
    event(PROPERTIES + "/UseControlPointWeights/CheckBox", "set_boolean", "false")
    apply()
    note("no_weights")
    with open(path("events.xml"), "w", encoding="utf-8") as file:
        file.write('<?xml version="1.0" ?>\n<pqevents>\n' + "\n".join(events) + "\n</pqevents>\n")


def run_paraview(home):
    settings = os.path.join(home, ".config", "ParaView")
    os.makedirs(settings)
    with open(os.path.join(settings, "ParaView5.11.0.ini"), "w", encoding="ascii") as file:
        file.write("[General]\nGeneralSettings.ShowWelcomeDialog=false\n")
    with open(path("wide.qss"), "w", encoding="ascii") as file:
        file.write(f"#propertiesPanel {{ min-width: {PANEL_WIDTH - 10}px }}\n")
    environment = dict(os.environ, HOME=home, XDG_RUNTIME_DIR=home)
    os.chmod(home, 0o700)
    screen = f"-noreset -screen 0 {SIZE[0]}x{SIZE[1]}x24"
    command = ["xvfb-run", "-a", "-s", screen, os.path.join(os.environ["IPIA_PARAVIEW_BIN"], "paraview"),
               "-stylesheet", path("wide.qss"), "--test-script", path("events.xml"), "--test-directory", path("."), "--exit"]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=270,
                          check=False)
    output = done.stdout + done.stderr
    assert "Success =  true" in output, output
    return output


def noted(name):
    with open(path(f"{name}.json"), encoding="utf-8") as file:
        return json.load(file)


def pixels(name, crop=None):
    size = (f"{crop}" if crop else f"{SIZE[0]}x{SIZE[1]}+0+0").split("+")[0]
    width, height = (int(word) for word in size.split("x"))
    command = ["convert", path(f"{name}.png")] + (["-crop", crop, "+repage"] if crop else [])
    done = subprocess.run([*command, "-depth", "8", "rgb:-"], capture_output=True, check=True)
    return np.frombuffer(done.stdout, dtype=np.uint8).reshape(height, width, 3).astype(int)


def share_of_surface(name):
    """Of the render view: what is neither its dark blue nor its frame."""
    view = pixels(name, "850x480+500+230")
    warm = view[:, :, 0] > view[:, :, 2] - 5
    return warm.mean()


def icons(name):
    """How many groups of rows of the screen a menu brings the orange of the icons to."""
    def orange(picture):
        return np.abs(pixels(picture) - ORANGE).max(axis=2) < 30

    rows = np.flatnonzero((orange(name) & ~orange("cloud")).any(axis=1))
    return 1 + np.count_nonzero(np.diff(rows) > 8) if len(rows) else 0


def menu():
    """The picture that has the open menu with an icon for each filter."""
    found = {name: icons(name) for name in (f"menu{i}" for i in range(1, 10))}
    assert 5 in found.values(), found
    return next(name for name, count in found.items() if count == 5)


def check(output):
    menu()
    for name, use in (("weights", 1), ("no_weights", 0)):
        assert noted(name)["UseControlPointWeights"] == use, (name, noted(name))
        assert noted(name)["points"] > 0, (name, noted(name))
    assert output.count("ERR|") == 1, output  # the refusal
    for name in ("cloud", "panel", "surface", "coarse", "undone", "box", "advanced", "refused"):
        assert pixels(name).shape == (SIZE[1], SIZE[0], 3), name
    cloud, surface, coarse, undone = (noted(n) for n in ("cloud", "surface", "coarse", "undone"))
    assert cloud["points"] == 5210 and cloud["cells"] == 0
    assert surface["type"] == "IPIASurfaceReconstruction"
    assert surface["Normals"] == ["POINTS", "Normals"]
    assert surface["GridSize"] == [0, 0, 0] and surface["FairingWeight"] == -1
    assert surface["points"] > 30000, surface
    assert coarse["GridSize"] == [24, 0, 0] and coarse["FairingWeight"] == 1
    assert 1000 < coarse["points"] < surface["points"] / 4, coarse
    assert undone == surface, (undone, surface)
    assert noted("box")["points"] == surface["points"]  # not applied yet
    refused = noted("refused")
    assert refused["GridSize"] == [2, 0, 0] and refused["points"] == 0, refused
    assert "GridSize is 2" in output, output
    # The kitten is in the picture: about a fifth of the view.
    for name in ("surface", "undone"):
        assert 0.05 < share_of_surface(name) < 0.6, (name, share_of_surface(name))
    assert share_of_surface("refused") < 0.02, share_of_surface("refused")


def keep(folder):
    os.makedirs(folder, exist_ok=True)
    colours = ["-colors", "128", "-define", "png:compression-level=9"]
    for name, crop in (("cloud", None), ("surface", None), ("box", None), ("refused", None)):
        subprocess.run(["convert", path(f"{name}.png"), "-resize", "1000x", *colours,
                        os.path.join(folder, f"paraview-{name}.png")], check=True)
    subprocess.run(["convert", path(f"{menu()}.png"), "-crop", MENU_PART, "+repage", *colours,
                    os.path.join(folder, "paraview-menu.png")], check=True)
    for name in ("panel", "advanced"):
        subprocess.run(["convert", path(f"{name}.png"), "-crop", f"{PANEL_WIDTH - 10}x{SIZE[1] - 440}+0+400",
                        "+repage", *colours, os.path.join(folder, f"paraview-{name}.png")], check=True)


def main():
    shutil.rmtree(FOLDER, ignore_errors=True)
    os.makedirs(FOLDER)
    columns = np.loadtxt(os.path.join(os.environ["IPIA_DATA_DIR"], "points_3", "kitten.xyz"))
    scan = path("kitten.ply")
    with open(scan, "w", encoding="ascii") as file:
        print(f"ply\nformat ascii 1.0\nelement vertex {len(columns)}", file=file)
        for field in ("x", "y", "z", "nx", "ny", "nz"):
            print(f"property float {field}", file=file)
        print("end_header", file=file)
        np.savetxt(file, columns[:, :6], fmt="%.7g")
    write_events(scan)
    with tempfile.TemporaryDirectory() as home:
        output = run_paraview(home)
    check(output)
    if len(sys.argv) > 1:
        keep(sys.argv[1])


main()
