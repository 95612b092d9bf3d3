"""Packages that only some work needs, loaded when that work is asked for, and the extra of Ulna that brings each.

`pip install ulna` brings what a calibration needs; `pip install "ulna[reports]"` also what draws and prints, and so on.
Whoever loads such a package asks `need` first, before any long work.
"""

from __future__ import annotations

import importlib.util

from ulna.ground.errors import UlnaInputError

EXTRAS: dict[str, tuple[str, ...]] = {
    "reports": ("matplotlib", "typst", "fontTools"),
    "tables": ("pyarrow", "h5py"),
    "search": ("scipy",),
    "judge": ("sklearn",),
    "dask": ("distributed",),
    "records": ("sqlalchemy", "alembic", "pg8000"),
    "workbench": ("fastapi", "uvicorn"),
    "laboratory": ("argon2", "authlib", "httpx2"),
    "mqtt": ("paho",),
    "ros": ("mcap", "mcap_ros2", "rosbags"),
    "opcua": ("asyncua",),
}
"""Extra, as in pyproject.toml → what is imported of it."""

PACKAGES = {"sklearn": "scikit-learn", "argon2": "argon2-cffi", "paho": "paho-mqtt", "mcap_ros2": "mcap-ros2-support"}
"""What is imported → the package that it is in, where that has another name."""


def installed(package: str) -> bool:
    """Whether a package can be imported; it is not loaded."""
    return importlib.util.find_spec(package) is not None


def need(what: str, *packages: str) -> None:
    """Raises UlnaInputError where a package is not installed that `what`, such as "option --pdf", needs."""
    for package in packages:
        if not installed(package):
            raise UlnaInputError(f"{what}: {lacking(package)}")


def lacking(module: str) -> str | None:
    """What to say of a module that cannot be imported; None where no extra brings it."""
    package = module.split(".")[0]
    for extra, packages in EXTRAS.items():
        if package in packages:
            named = PACKAGES.get(package, package)
            return (
                f"the package {named} is not installed; expected it, as Ulna's extra '{extra}' brings it. "
                f'Run: pip install "ulna[{extra}]"'
            )
    return None
