"""What the docs show of `ulna check`: a history of mornings, and the one after the arm was knocked."""

from pathlib import Path

from docs_running import ulna

PROTOCOL = "examples/platinum/protocol.toml"
CHECKS = "out/checks"
#: file below docs/output → which of the mornings, from the end
SHOWN = {"check-steady.txt": -2, "check.txt": -1}


def check_outputs(folder: Path) -> dict[str, str]:
    """File name → what the command prints. Raises RuntimeError where it cannot be used."""
    printed = []
    for readings in sorted((folder / "examples" / "platinum").glob("morning-*.csv")):
        day = readings.stem.removeprefix("morning-")
        (folder / CHECKS).mkdir(parents=True, exist_ok=True)
        arguments = ["check", PROTOCOL, f"examples/platinum/{readings.name}", "--date", f"2026-{day}T07:45"]
        done = ulna([*arguments, "--history", CHECKS, "-o", f"{CHECKS}/{day}.json"], folder)
        if done.returncode not in (0, 1):
            raise RuntimeError(f"ulna {' '.join(arguments)} exited with {done.returncode}:\n{done.stderr}")
        printed.append(done.stdout)
    return {name: printed[which] for name, which in SHOWN.items()}
