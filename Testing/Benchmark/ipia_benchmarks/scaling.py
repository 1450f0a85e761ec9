# SPDX-License-Identifier: BSD-3-Clause
"""Cost against points and cells, and the core against the machine: python3 -m ipia_benchmarks.scaling --help"""
import argparse
import dataclasses
import json
import os
import pathlib
import subprocess
import sys

from . import jobs, measuring
from .tables import figure, table

POINTS = (10**4, 10**5, 10**6, 10**7)
CELLS = (64, 128, 256, 512, 1024)
POINTS_OF_CELLS = 10**6
LIMIT_SECONDS = 1800

#: Points in, surface out, brick by brick.
JOB = next(job for job in jobs.JOBS if job.name == jobs.OURS[1])


@dataclasses.dataclass
class Measurement:
    """A job of some size on one processor and on two."""

    size: int
    one: measuring.Run
    two: measuring.Run

    @property
    def failure(self):
        return self.one.failure or self.two.failure

    def cpu_of(self, stage):
        return sum(s["cpu"] for s in self.one.stages if s["stage"] == stage)

    def fit_speed_up(self):
        """Wall time of the fit on one thread over that on two."""
        one, two = (sum(s["wall"] for s in run.stages if s["stage"] == "fit")
                    for run in (self.one, self.two))
        return one / two


def cloud(programs, folder, count):
    """A cloud of so many points; made once."""
    path = folder / f"bumps-{count}.ply"
    if not path.exists():
        unfinished = path.with_suffix(".unfinished")
        subprocess.run([programs / "MakeClouds", "bumps", str(count), unfinished], check=True)
        unfinished.rename(path)
    return path


def measure(programs, folder, points, sizes, cells):
    """The sizes are numbers of cells, or else of points; ends with the first that fails."""
    found = []
    processors = sorted(os.sched_getaffinity(0))
    for size in sizes:
        command = JOB.command([programs], cloud(programs, folder, points or size),
                              folder / "surface.ply") + ([str(size)] if cells else [])
        runs = [measuring.run(command, LIMIT_SECONDS, measuring.environment(OMP_NUM_THREADS=str(n)),
                              processors[:n]) for n in (1, 2)]
        found.append(Measurement(size, *runs))
        print(f"{size}: {found[-1].failure or f'{runs[0].wall:.2f} s, {runs[1].wall:.2f} s'}",
              file=sys.stderr)
        if found[-1].failure:
            break
    return found


def core(programs, folder):
    """The counters of BenchmarkCore, by benchmark."""
    out = folder / "core.json"
    subprocess.run([programs / "BenchmarkCore", f"--benchmark_out={out}",
                    "--benchmark_out_format=json"], check=True, env=measuring.environment(),
                   stdout=sys.stderr)
    return {one["name"].split("/min_time")[0].split("/iterations")[0]: one
            for one in json.loads(out.read_text())["benchmarks"]}


def table_of(label, measurements):
    stages = ["read", "fit", "contour", "write"]
    rows = []
    for one in measurements:
        if one.failure:
            continue
        facts = one.one.facts
        rows.append([one.size, " x ".join(map(str, facts["grid"])), facts["triangles"]] +
                    [figure(one.cpu_of(stage), 2) for stage in stages] +
                    [figure(one.one.cpu), figure(one.one.wall), figure(one.two.wall),
                     figure(one.one.wall / one.two.wall, 2), figure(one.fit_speed_up(), 2),
                     figure(one.one.peak_mb)])
    failures = "".join(f"\n{one.size}: {one.failure}\n" for one in measurements if one.failure)
    return table([label.split(",")[0], "coefficients", "triangles", *[f"{stage}, s" for stage in stages],
                  "all, s", "wall, 1 thread, s", "wall, 2 threads, s", "speed-up", "speed-up of the fit",
                  "peak memory, MB"], rows) + failures


def table_of_core(found):
    rows = []
    for name, title in (("sweep", "values"), ("hermiteSweep", "values and gradients")):
        for count in (5, 50):
            one = found[f"{name}/{count}"]
            rows.append([title, count, figure(one["ns/row"]), figure(2 * one["ns/row on 2"]),
                         figure(one["speed-up on 2"]), figure(one["share of multiply-add rate"], 2),
                         figure(one["share of memory rate"], 2)])
    return table(["rows of", "rows a cell", "ns a row, 1 thread", "ns a row and thread, 2 threads",
                  "speed-up", "share of multiply-adds", "share of memory"], rows)


def report(measurements, found):
    rates = found["machine"]
    lines = ["# Scaling\n", f"{measuring.machine()}.\n"]
    for label, runs in measurements.items():
        lines += [f"## Against {label}\n", table_of(label, runs)]
    return "\n".join(lines + [
        "## The core's sweep over the rows, one level\n", table_of_core(found),
        f"Limits of one thread: {figure(rates['1e9 multiply-adds/s, double'])}e9 multiply-adds of "
        f"doubles a second, {figure(rates['1e9 multiply-adds/s, float'])}e9 of floats, "
        f"{figure(rates['memory, GB/s'])} GB/s of memory. Rows of values are in double, those of "
        "values and gradients in single precision.\n",
        f"Sampling: {figure(found['sample']['ns/sample'])} ns a sample, "
        f"{figure(found['sample']['times filling'])} times filling the memory.\n"])


def main():
    parser = argparse.ArgumentParser(prog="scaling.sh", description=__doc__)
    parser.add_argument("output", type=pathlib.Path, help="folder of clouds and results")
    parser.add_argument("--programs", type=pathlib.Path, required=True)
    parser.add_argument("--points", type=int, nargs="+", default=POINTS)
    parser.add_argument("--cells", type=int, nargs="+", default=CELLS)
    given = parser.parse_args()

    given.output.mkdir(parents=True, exist_ok=True)
    found = core(given.programs, given.output)
    measurements = {
        "points": measure(given.programs, given.output, None, given.points, cells=False),
        f"cells, {POINTS_OF_CELLS} points":
            measure(given.programs, given.output, POINTS_OF_CELLS, given.cells, cells=True)}
    text = report(measurements, found)
    (given.output / "scaling.md").write_text(text)
    (given.output / "scaling.json").write_text(json.dumps(
        {label: list(map(dataclasses.asdict, runs)) for label, runs in measurements.items()}, indent=1))
    from . import plots  # pylint: disable=import-outside-toplevel; large, see measuring
    plots.scaling(measurements, given.output)
    print(text)


if __name__ == "__main__":
    main()
