#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Every task of Documentation/Tasks.md: figures, pictures, and these written into the page.

    python3 run_all.py --data build/data --output ipia-output/tasks [--page Documentation/Tasks.md]

With a page, the figures of a script go between the lines of ``` after <!-- figures: SCRIPT -->.
"""
import argparse
from pathlib import Path
import subprocess
import sys

HERE = Path(__file__).resolve().parent
TASKS = ("terrain.py", "statue.py", "part.py", "organ.py", "photos.py")
NORMALS = "EstimateNormals.py"
FILES = ("points_3/kitten.xyz", "points_3/ball.ply", "points_3/oni.pwn", "meshes/bunny00.off",
         "meshes/refined_elephant.off", "meshes/armadillo.off", "meshes/fandisk.off",
         "meshes/camel.off")
MARK = "<!-- figures: {} -->\n```text\n"
END = "```\n"


def command(script, data, output, picture=True):
    """What runs a script; EstimateNormals.py takes files."""
    if script == NORMALS:
        return [sys.executable, HERE.parent / script, *(data / file for file in FILES)]
    options = [] if picture else ["--no-picture"]
    return [sys.executable, HERE / script, "--data", data, "--output", output, *options]


def figures_on(page, script):
    """The figures of a script as a page has them, and where they begin and end in its text."""
    begin = page.index(MARK.format(script)) + len(MARK.format(script))
    end = page.index(END, begin)
    return page[begin:end], begin, end


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, default=Path("build/data"))
    parser.add_argument("--output", type=Path, default=Path("ipia-output/tasks"))
    parser.add_argument("--page", type=Path, help="renew the figures on this page")
    given = parser.parse_args()
    for script in (*TASKS, NORMALS):
        print(f"--- {script}", flush=True)
        done = subprocess.run(command(script, given.data, given.output), check=False, text=True,
                              stdout=subprocess.PIPE)
        print(done.stdout, end="")
        if done.returncode:
            return f"{script} failed"
        if given.page:
            page = given.page.read_text(encoding="utf-8")
            _, begin, end = figures_on(page, script)
            given.page.write_text(page[:begin] + done.stdout + page[end:], encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
