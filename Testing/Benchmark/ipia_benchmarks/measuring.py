# SPDX-License-Identifier: BSD-3-Clause
"""Processes and what they cost.

The kernel counts the peak memory of a new process from that of the one that starts it, so this one
stays small while it measures: it imports nothing but the standard library.
"""
import dataclasses
import json
import os
import pathlib
import platform
import signal
import statistics
import subprocess
import tempfile
import threading
import time


@dataclasses.dataclass
class Run:
    """One process: seconds and megabytes, and what it said about itself."""

    cpu: float
    wall: float
    peak_mb: float
    stages: list = dataclasses.field(default_factory=list)
    facts: dict = dataclasses.field(default_factory=dict)
    failure: str = ""


def environment(**more):
    """Threads that wait sleep, for all programs alike: else their waiting counts as their work."""
    return dict(os.environ, OMP_WAIT_POLICY="passive", **more)


def run(command, limit, env=None, processors=None):
    """Runs a command, for no longer than limit seconds, on the given processors (None: all).

    Lines of JSON in its output are its stages and other facts.
    """
    everywhere = os.sched_getaffinity(0)
    with tempfile.TemporaryFile("w+") as output, tempfile.TemporaryFile("w+") as errors:
        os.sched_setaffinity(0, processors or everywhere)
        process = subprocess.Popen(command, stdout=output, stderr=errors, env=env or environment())
        os.sched_setaffinity(0, everywhere)
        begin = time.monotonic()
        late = threading.Event()
        timer = threading.Timer(limit, lambda: (late.set(), os.kill(process.pid, signal.SIGKILL)))
        timer.start()
        _, status, used = os.wait4(process.pid, 0)
        wall = time.monotonic() - begin
        timer.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        errors.seek(0)
        result = Run(used.ru_utime + used.ru_stime, wall, used.ru_maxrss / 1024)
        for line in output:
            if line.startswith("{"):
                result.facts.update(json.loads(line))
        result.stages = result.facts.pop("stages", [])
        if late.is_set():
            result.failure = f"over {limit:g} s"
        elif process.returncode != 0:
            last = errors.read().strip().splitlines()[-1:] or ["no message"]
            result.failure = f"{_exit(process.returncode)}: {last[0]}"
    return result


def _exit(code):
    return signal.Signals(-code).name if code < 0 else f"exit {code}"


def median(runs):
    """The run whose processor time is the middle one; a failure counts for all."""
    for one in runs:
        if one.failure:
            return one
    return sorted(runs, key=lambda one: one.cpu)[(len(runs) - 1) // 2]


def spread(runs):
    """How far processor times are apart, as a share of their median."""
    times = [one.cpu for one in runs]
    return (max(times) - min(times)) / statistics.median(times)


def machine():
    """One line about the processor."""
    model = platform.machine()
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            model = line.split(":", 1)[1].strip()
            break
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30
    return f"{model}, {len(os.sched_getaffinity(0))} processors, {memory:.0f} GB"


def versions(packages):
    """Of Debian packages, by name; those that are not installed are left out."""
    found = {}
    for package in packages:
        answer = subprocess.run(["dpkg-query", "-W", "-f", "${db:Status-Status} ${Version}", package],
                                capture_output=True, text=True, check=False).stdout.split()
        if answer[:1] == ["installed"]:
            found[package] = answer[1]
    return found
