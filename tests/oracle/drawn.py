"""Where the links of a URDF are: the description as written, read and multiplied out without the program."""

from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from scipy.spatial.transform import Rotation

from .chain import Array

TURNING = ("revolute", "continuous")


def drawn_joints(path: Path, tip_link: str) -> list[ElementTree.Element]:
    """The joints from the root to a link."""
    above = {joint.find("child").get("link"): joint for joint in ElementTree.parse(path).getroot().findall("joint")}
    way = []
    while tip_link in above:
        way.insert(0, above[tip_link])
        tip_link = way[0].find("parent").get("link")
    return way


def drawn_frames(path: Path, tip_link: str, q_rad: Array) -> Array:
    """(N, n) joint angles in rad, of prismatic joints mm → (N, 4, 4) of the link in the root's frame, mm."""
    out = np.tile(np.eye(4), (len(q_rad), 1, 1))
    angles = iter(np.asarray(q_rad).T)
    for joint in drawn_joints(path, tip_link):
        origin = joint.find("origin")
        step = np.eye(4)
        if origin is not None:
            rpy = [float(part) for part in origin.get("rpy", "0 0 0").split()]
            step[:3, :3] = Rotation.from_euler("xyz", rpy).as_matrix()  # lower case: about fixed axes
            step[:3, 3] = [1000 * float(part) for part in origin.get("xyz", "0 0 0").split()]
        out = out @ step
        if joint.get("type") == "prismatic":
            shifted = np.tile(np.eye(4), (len(q_rad), 1, 1))
            axis = np.array([float(part) for part in joint.find("axis").get("xyz").split()])
            shifted[:, :3, 3] = np.outer(next(angles), axis / np.linalg.norm(axis))
            out = out @ shifted
        if joint.get("type") in TURNING:
            element = joint.find("axis")
            axis = np.array([float(part) for part in (element.get("xyz") if element is not None else "1 0 0").split()])
            turned = np.tile(np.eye(4), (len(q_rad), 1, 1))
            turned[:, :3, :3] = Rotation.from_rotvec(np.outer(next(angles), axis / np.linalg.norm(axis))).as_matrix()
            out = out @ turned
    return out


def drawn_tips(path: Path, tip_link: str, q_rad: Array) -> Array:
    """(N, n) joint angles in rad → (N, 3) the link's origin in the root's frame, mm."""
    return drawn_frames(path, tip_link, q_rad)[:, :3, 3]
