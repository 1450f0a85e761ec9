# SPDX-License-Identifier: BSD-3-Clause
"""A pvserver and a client that runs a script on it.

run_server.py <ranks> <mpiexec> <folder of ParaView's programs> <script>
"""
import os
import signal
import socket
import subprocess
import sys
import time

ranks, mpiexec, programs, script = sys.argv[1:]


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


port = free_port()
command = [os.path.join(programs, "pvserver"), f"--server-port={port}"]
if int(ranks) > 1:
    command = [mpiexec, "--oversubscribe", "-np", ranks, *command]
server = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          start_new_session=True)
try:
    heard = ""
    deadline = time.time() + 60
    while "Accepting connection" not in heard and time.time() < deadline:
        line = server.stdout.readline()
        if not line:
            break
        heard += line
    assert "Accepting connection" in heard, heard
    client = subprocess.run([os.path.join(programs, "pvpython"), script, str(port), ranks],
                            check=False, timeout=120)
    try:
        heard += server.communicate(timeout=5)[0]
    except subprocess.TimeoutExpired:  # MPI can take its time to end
        os.killpg(server.pid, signal.SIGTERM)
        heard += server.communicate()[0]
    print("--- server\n" + heard)
    warned = "are fitted on the first of" in heard
    assert warned == (int(ranks) > 1), "the server's warning"
finally:
    if server.poll() is None:
        os.killpg(server.pid, signal.SIGTERM)
sys.exit(client.returncode)
