"""Forks workers from a process that has loaded everything, so that a run starts within milliseconds.

Requests arrive on a socket: each has two file descriptors (the connection and the output of a new worker) and the maximum memory
of its model. The replies are the worker's process id and later its exit status. When the server is gone, this process ends all workers
and itself.

It is not that of `multiprocessing`, whose workers have no output and process group of their own, and which reports neither that a signal
has stopped one nor ends what they leave behind.
"""

from __future__ import annotations

import errno
import gc
import os
import select
import signal
import socket
import struct
import sys
import time
from contextlib import suppress
from pathlib import Path
from typing import Literal

from workbench.worker.orphans import adopt, end_orphans

ANSWER = struct.Struct("!Bqi")
"""A reply: its kind (BORN, DEAD, HALTED or READY), the process id, and a status. For DEAD, the status is that of
`os.waitstatus_to_exitcode`; for HALTED, the signal that has stopped the worker, or 0 if it continues. A BORN whose process id is
negative reports that no worker could be forked, by the number of the error.
"""
BORN, DEAD, READY, HALTED = 1, 2, 3, 4
ASK = struct.Struct("!i")
"""A request: the maximum memory of a new worker's model [MB]."""
FAREWELL = 1.0
"""Maximum time to wait for the end of its workers at shutdown [s]."""
SMALL = """
from dataclasses import dataclass

from actr3d.actr import *
from actr3d.motor import Motor
from actr3d.sgoms import SGOMS
from actr3d.simulation import Simulation
from actr3d.vision import Vision
from actr3d.world import Aperture, Floor, Mannequin, Scene


class Blind(SGOMS):
    motor = Motor()

    def init():
        motor.rotate("torso", "yaw", 10)


class Walker(SGOMS):
    b_visual = Buffer()
    vision = Vision(b_visual)
    motor = Motor()

    def init():
        motor.rotate("torso", "yaw", 10)
        vision.request("feature:opening")


@dataclass(frozen=True)
class Parameters:
    sees: bool = True


def build(parameters: Parameters) -> Simulation:
    agent = Walker if parameters.sees else Blind
    return Simulation(Scene(parts=(Floor(), Aperture(), Mannequin(name="walker"))), {"walker": agent})
"""
"""A model that uses what most models use: whatever it makes the library load, parse or compile is ready in every worker."""


def main(number: int) -> None:
    """Serves requests until the server is gone.

    Args:
        number: The file descriptor of the socket to the server.
    """
    gc.disable()  # nothing that is loaded here is garbage
    preload()
    gc.enable()
    gc.set_threshold(5000, 10, 10)  # long runs, whose events stay, are up to a fifth faster than with Python's 700
    adopt()
    control = socket.socket(fileno=number)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    woken, wake = os.pipe()
    os.set_blocking(wake, False)
    os.set_blocking(woken, False)
    signal.signal(signal.SIGCHLD, lambda _, __: None)  # the wakeup pipe reports the signal
    signal.set_wakeup_fd(wake)
    gc.collect()
    gc.freeze()
    _answer(control, READY, os.getpid(), 0)
    children: set[int] = set()
    while True:
        ready, _, _ = select.select([control, woken], [], [])
        if woken in ready:
            with suppress(BlockingIOError):
                os.read(woken, 4096)
            _bury(control, children)
        if control not in ready:
            continue
        try:
            data, descriptors, _, _ = socket.recv_fds(control, ASK.size, 2)
        except ConnectionError:
            break
        if not data:
            break
        pid = _born(control, (woken, wake), descriptors, ASK.unpack(data)[0])
        if pid > 0:
            children.add(pid)
        _answer(control, BORN, pid, 0)
    _end_all(control, children)


def preload() -> None:
    """Imports and compiles what models need, so that runs start at once: a small one, without and with eyes, runs for 0.1 s.

    In a new installation, a copy of this process compiles the longer half of the camera meanwhile, which the eyes then load.
    """
    from actr3d.actr.kernel.run_limits import RunLimits
    from actr3d.runner.model_factory import Blueprint
    from workbench.worker import program_run, recorded, simulation_run  # pyright: ignore[reportUnusedImport] # noqa: F401

    copy = os.fork()
    if copy == 0:
        try:
            compile_camera("rows")
        finally:
            os._exit(0)
    compile_camera("scene")
    compile_detectors()
    with RunLimits(seed=0):
        blueprint = Blueprint(SMALL, "small.py", Path())
        for sees in (False, True):
            if sees:
                os.waitpid(copy, 0)
            simulation, _ = blueprint.build({"sees": sees})
            simulation.run(0.1)


def compile_camera(half: Literal["scene", "rows"]) -> None:
    """Compiles half of what a camera needs, or loads it."""
    import mujoco

    from actr3d.camera.geometric import GeometricCamera

    xml = '<mujoco><worldbody><site name="eye"/><geom type="sphere" size="1" pos="3 0 0"/></worldbody></mujoco>'
    mj_model = mujoco.MjModel.from_xml_string(xml)
    mj_data = mujoco.MjData(mj_model)
    mujoco.mj_kinematics(mj_model, mj_data)
    GeometricCamera(mj_model, site="eye").compile_half(mj_data, half)


def compile_detectors() -> None:
    """Compiles what the detectors need, or loads it: they are given a view without depth, in which they find nothing."""
    import numpy as np

    from actr3d.camera.kernel.dtypes import EXTENT
    from actr3d.camera.parameters import CameraParameters
    from actr3d.camera.view import View
    from actr3d.vision.detectors.obstacle import obstacle
    from actr3d.vision.detectors.opening import opening

    # Arrays that cannot be written to are of other types for numba; those of a camera are such.
    view = View(CameraParameters(), np.frombuffer(bytes(2 * EXTENT.itemsize), EXTENT), np.frombuffer(np.eye(3).tobytes()).reshape(3, 3))
    opening(view)
    obstacle(view)


def _end_all(control: socket.socket, children: set[int]) -> None:
    """Ends all workers and the processes they leave behind; stops waiting after `FAREWELL`, as the server is gone."""
    for pid in children:
        with suppress(OSError):
            os.killpg(pid, signal.SIGKILL)
    end = time.monotonic() + FAREWELL
    while time.monotonic() < end:
        _bury(control, children)
        if not children:
            time.sleep(0.01)  # for processes that the last worker has left behind
            end_orphans(children)
            return
        time.sleep(0.005)


def _answer(control: socket.socket, *what: int) -> None:
    """Sends the server a reply; if the server is gone, the next read from it shows that."""
    with suppress(OSError):
        control.sendall(ANSWER.pack(*what))


def _born(control: socket.socket, pipe: tuple[int, int], descriptors: list[int], memory: int) -> int:
    """Forks a worker and returns its process id, or the negative number of the error; does not return in the worker."""
    from workbench.worker.main import main as work

    try:
        pid = os.fork()
    except OSError as error:
        pid = -(error.errno or errno.EAGAIN)
    if pid == 0:
        sys.dont_write_bytecode = True  # on a full disk, Python leaves half a file of it, and fails to read it ever after
        signal.set_wakeup_fd(-1)
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        for descriptor in pipe:
            os.close(descriptor)
        control.close()
        wire, output = descriptors
        try:
            work(socket.socket(fileno=wire), output, memory)
        finally:
            os._exit(1)  # reached only if the worker failed to end itself
    for descriptor in descriptors:
        os.close(descriptor)
    return pid


def _bury(control: socket.socket, children: set[int]) -> None:
    """Reports to the server which children have died, and which a signal has stopped or continued."""
    for pid in list(children):
        with suppress(ChildProcessError):
            done, status = os.waitpid(pid, os.WNOHANG | os.WUNTRACED | os.WCONTINUED)
            if done and (os.WIFSTOPPED(status) or os.WIFCONTINUED(status)):
                _answer(control, HALTED, pid, os.WSTOPSIG(status) if os.WIFSTOPPED(status) else 0)
            elif done:
                children.discard(pid)
                with suppress(OSError):
                    os.killpg(pid, signal.SIGKILL)  # processes left in its group
                _answer(control, DEAD, pid, os.waitstatus_to_exitcode(status))
    end_orphans(children)


if __name__ == "__main__":
    main(int(sys.argv[1]))
