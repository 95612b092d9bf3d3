"""Pinocchio in C++, the forward map only: it has no derivatives by link parameters. pinocchio.cpp beside this file."""

import importlib.util
import json
import tempfile
from pathlib import Path

import numpy as np

from benchmarks.peers import Contender, MissingPeerError, Times
from benchmarks.peers.native import FLAGS, compile_to, run
from benchmarks.peers.numpy_map import tips
from benchmarks.readings import TRUTH, poses
from benchmarks.tasks import FORWARD_POSES

EIGEN = Path("/usr/include/eigen3")


def contender() -> Contender:
    package = importlib.util.find_spec("cmeel")
    if package is None or package.origin is None:
        raise MissingPeerError("the package pin is not installed")
    prefix = Path(package.origin).parent.parent / "cmeel.prefix"
    if not (prefix / "include/pinocchio").is_dir():
        raise MissingPeerError("the package pin is not installed")
    folder = tempfile.TemporaryDirectory()
    program = Path(folder.name) / "pinocchio"
    flags = [
        "-std=c++17",
        "-DNDEBUG",
        # Pinocchio's list of joint types is longer than Boost's default limit.
        "-DBOOST_MPL_LIMIT_LIST_SIZE=30",
        "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS",
        f"-I{prefix / 'include'}",
        f"-I{EIGEN}",
    ]
    compile_to(program, Path(__file__).with_suffix(".cpp"), flags, cxx=True)

    def solve(count: int) -> tuple[str, float]:
        q_rad = poses(count, seed=7)
        files = [str(Path(folder.name) / name) for name in ("poses", "parameters", "tips")]
        q_rad.tofile(files[0])
        TRUTH.tofile(files[1])
        answer = json.loads(run(program, [files[0], str(count), files[1], files[2]]))
        found = np.fromfile(files[2]).reshape(-1, 3)
        if not np.max(np.abs(found - tips(TRUTH, q_rad))) < 1e-9:
            raise RuntimeError("Pinocchio: the forward map differs")
        return str(answer["version"]), float(answer["forward_s"])

    def measure(quick: bool) -> Times:
        return {"forward": solve(FORWARD_POSES)[1]}

    return Contender(
        "Pinocchio",
        f"Pinocchio {solve(10)[0]}",
        f"C++ forwardKinematics compiled with {' '.join(FLAGS)}, one pose a call; forward map only",
        measure,
    )
