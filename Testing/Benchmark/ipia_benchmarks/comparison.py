# SPDX-License-Identifier: BSD-3-Clause
"""All jobs on all clouds: python3 -m ipia_benchmarks.comparison --help"""
import argparse
import dataclasses
import json
import pathlib
import subprocess
import sys

from . import jobs, measuring
from .tables import figure, geometric_mean, table

#: Jobs that take longer than this are not repeated.
SLOW_SECONDS = 10


@dataclasses.dataclass
class Result:
    """What became of one job on one cloud."""

    runs: list
    quality: dict

    @property
    def run(self):
        return measuring.median(self.runs)


def make_clouds(programs, folder, meshes):
    """The clouds, as MakeClouds describes them."""
    folder.mkdir(parents=True, exist_ok=True)
    command = [programs[0] / "MakeClouds", folder] + ([meshes] if meshes else [])
    output = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    return [json.loads(line) for line in output.splitlines()]


def surface_of(folder, cloud, job):
    name = f"{cloud['name']} {job.name}".replace(", ", "-").replace(" ", "-")
    return folder / f"{name}.ply"


def measure(clouds, chosen, programs, folder, repetitions, limit):
    """Runs of each (cloud, job): one round after the other, so that all meet the same disturbances."""
    folder.mkdir(parents=True, exist_ok=True)
    runs = {}
    for repetition in range(repetitions):
        for cloud in clouds:
            for job in chosen:
                key = cloud["name"], job.name
                done = runs.setdefault(key, [])
                if done and (done[0].failure or done[0].cpu > SLOW_SECONDS):
                    continue
                surface = surface_of(folder, cloud, job)
                surface.unlink(missing_ok=True)
                command = job.command(programs, cloud["cloud"], surface)
                if command is None:
                    done.append(measuring.Run(0, 0, 0, failure="not built"))
                else:
                    done.append(measuring.run(command, limit))
                one = done[-1]
                print(f"{repetition + 1}/{repetitions} {cloud['name']}: {job.name}: "
                      f"{one.failure or f'{one.cpu:.2f} s'}", file=sys.stderr)
    return runs


def evaluate(clouds, chosen, programs, folder, runs):
    """Result of each (cloud, job)."""
    results = {}
    for cloud in clouds:
        for job in chosen:
            key = cloud["name"], job.name
            quality = {}
            if not measuring.median(runs[key]).failure:
                found = measuring.run(
                    [programs[0] / "EvaluateSurface", surface_of(folder, cloud, job), cloud["truth"]],
                    limit=600)
                quality = {"failure": found.failure} if found.failure else found.facts
            results[key] = Result(runs[key], quality)
    return results


def topology(quality):
    """components/genus/boundary edges"""
    if "components" not in quality:
        return "–"
    genus = "–" if quality["nonmanifold_edges"] else quality["genus"]
    return f"{quality['components']}/{genus}/{quality['boundary_edges']}"


class Report:
    """The tables of a comparison."""

    def __init__(self, clouds, chosen, results):
        self.clouds, self.jobs, self.results = clouds, chosen, results

    def by_job(self, cell):
        """A row for each job, a column for each cloud."""
        return table([""] + [cloud["name"] for cloud in self.clouds],
                     [[job.name] + [cell(self.results[cloud["name"], job.name])
                                    for cloud in self.clouds] for job in self.jobs])

    def quantity(self, key, digits=3):
        return self.by_job(lambda one: figure(one.quality.get(key), digits))

    def cost(self, attribute, digits=3):
        return self.by_job(
            lambda one: one.run.failure.split(":")[0] or figure(getattr(one.run, attribute), digits))

    @staticmethod
    def quantities():
        """What is told as a multiple of ours."""
        return {"Processor time": lambda one: one.run.cpu,
                "Chamfer distance": lambda one: one.quality.get("chamfer"),
                "Peak memory": lambda one: one.run.peak_mb}

    def ratio(self, cloud, job, value):
        """A job's value over ours; None where either failed."""
        one, ours = (self.results[cloud["name"], name] for name in (job.name, jobs.OURS[0]))
        if one.run.failure or ours.run.failure or not value(one) or not value(ours):
            return None
        return value(one) / value(ours)

    def ratios(self, value):
        header = [""] + [cloud["name"] for cloud in self.clouds] + ["geometric mean"]
        rows = []
        for job in self.jobs:
            row = [self.ratio(cloud, job, value) for cloud in self.clouds]
            rows.append([job.name] + [figure(one) for one in row + [geometric_mean(row)]])
        return table(header, rows)

    def stages(self):
        """Processor time of the stages of each job on one cloud."""
        cloud = next((c for c in self.clouds if c["name"] == "bunny"), self.clouds[0])
        header = [cloud["name"], "start", "read", "fit", "sample", "contour", "write"]
        rows = []
        for job in self.jobs:
            times = {s["stage"]: s["cpu"] for s in self.results[cloud["name"], job.name].run.stages}
            merged = times.get("fit and contour")
            rows.append([job.name] + [
                "(in fit)" if merged and stage == "contour" else
                figure(merged if merged and stage == "fit" else times.get(stage), 2)
                for stage in header[1:]])
        return table(header, rows)

    def failures(self):
        lines = [f"- {job.name}, {cloud['name']}: {failure}\n"
                 for cloud in self.clouds for job in self.jobs
                 for one in [self.results[cloud["name"], job.name]]
                 for failure in [one.run.failure or one.quality.get("failure")] if failure]
        return "".join(lines) or "None.\n"

    def text(self, repetitions, limit):
        packages = ", ".join(f"{name} {version}" for name, version in
                             measuring.versions(jobs.PACKAGES).items())
        repeated = [one.runs for one in self.results.values() if len(one.runs) > 1]
        spread = max(map(measuring.spread, repeated), default=0)
        points = table(["cloud", "points"], [[c["name"], c["points"]] for c in self.clouds])
        return "\n".join([
            "# Comparison\n",
            f"{measuring.machine()}. {packages}.",
            f"Medians of {repetitions} runs in turn (one where a job takes over {SLOW_SECONDS} s), at most "
            f"{limit:g} s each; processor times of a job were up to {100 * spread:.0f} % apart.\n",
            points,
            "## Chamfer distance, % of the diagonal\n", self.quantity("chamfer"),
            "## Hausdorff distance, % of the diagonal\n", self.quantity("hausdorff", 2),
            "## Normal consistency\n", self.quantity("normals", 4),
            "## Components/genus/boundary edges\n", self.by_job(lambda one: topology(one.quality)),
            "## Processor time, s\n", self.cost("cpu", 2),
            "## Wall time, s\n", self.cost("wall", 2),
            "## Peak memory, MB\n", self.cost("peak_mb"),
            *[f"## {name}, times that of {jobs.OURS[0]}\n\n{self.ratios(value)}"
              for name, value in self.quantities().items()],
            "## Processor time by stage, s\n", self.stages(),
            "## Failures\n", self.failures()])


def main():
    parser = argparse.ArgumentParser(prog="compare.sh", description=__doc__)
    parser.add_argument("output", type=pathlib.Path, help="folder of clouds, surfaces and results")
    parser.add_argument("--programs", type=pathlib.Path, nargs="+", required=True,
                        help="folders of the programs, that of this project first")
    parser.add_argument("--meshes", type=pathlib.Path, help="folder that holds meshes/bunny00.off")
    parser.add_argument("--repetitions", type=int, default=5)
    parser.add_argument("--limit", type=float, default=300, help="seconds that a job may take")
    parser.add_argument("--clouds", nargs="+", help="only these")
    given = parser.parse_args()

    clouds = make_clouds(given.programs, given.output / "clouds", given.meshes)
    clouds = [cloud for cloud in clouds if not given.clouds or cloud["name"] in given.clouds]
    if not clouds:
        parser.error("no cloud has such a name")
    surfaces = given.output / "surfaces"
    runs = measure(clouds, jobs.JOBS, given.programs, surfaces, given.repetitions, given.limit)
    results = evaluate(clouds, jobs.JOBS, given.programs, surfaces, runs)
    report = Report(clouds, jobs.JOBS, results)
    text = report.text(given.repetitions, given.limit)
    (given.output / "comparison.md").write_text(text)
    (given.output / "comparison.json").write_text(json.dumps(
        [dict(cloud=cloud, job=job, **dataclasses.asdict(one)) for (cloud, job), one in results.items()],
        indent=1))
    from . import plots  # pylint: disable=import-outside-toplevel; large, see measuring
    plots.comparison(report, jobs.OURS, given.output)
    print(text)


if __name__ == "__main__":
    main()
