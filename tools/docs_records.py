"""What the docs show of `ulna record`: a laboratory's year, played day by day.

The clock of the record is set to the day of each command, and hashes, which depend on when a result was made, are shown
as others of the same length: nothing else of what is printed is changed.
"""

import hashlib
import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from unittest import mock

from docs_running import reader_folder, ulna

CHECK = "check examples/platinum/protocol.toml examples/platinum/morning-11-{day}.csv"
#: (day, file below docs/output or "", command), in order
YEAR: list[tuple[str, str, str]] = [
    ("2026-03-27", "year-init.txt", "record init bench"),
    (
        "2026-03-27",
        "year-arm.txt",
        'record arm P7 --maker "Example Arms" --model Platinum --serial P07-0815 --owner "Sample Works"',
    ),
    (
        "2026-03-27",
        "year-artefact.txt",
        'record artefact KB-443 --value "length=443.172±0.001" --number EX-2025-0911 --valid-from 2025-10-01 '
        "--valid-to 2027-09-30 --serial KS-443",
    ),
    ("2026-03-31", "", "calibrate examples/platinum/study.toml -o out/2026"),
    (
        "2026-03-31",
        "year-add.txt",
        "record add out/2026/result.json --arm P7 --at 2026-03-31 --study examples/platinum/study.toml "
        "--readings examples/platinum/bars.csv --on KB-443",
    ),
    ("2026-04-01", "", 'record person "Erika Muster" --role reviewer'),
    ("2026-04-01", "", "record set four-eyes yes"),
    ("2026-04-01", "year-refused.txt", "record issue P7 examples/platinum/laboratory.toml -o out/certificate.pdf"),
    (
        "2026-04-01",
        "year-issue.txt",
        "record issue P7 examples/platinum/laboratory.toml -o out/certificate.pdf --number EX-2026-0042 "
        '--approved-by "Erika Muster"',
    ),
    ("2026-04-01", "", 'record interval P7 --set 365 --why "as the maker advises"'),
    ("2026-09-01", "year-due.txt", "record due"),
    *(
        (
            f"2026-11-{day}",
            f"year-check-{day}.txt" if day == "18" else "",
            f"{CHECK.format(day=day)} --date 2026-11-{day}T07:45 -o out/{day}.json --record P7",
        )
        for day in ("02", "04", "06", "09", "11", "13", "16", "18")
    ),
    ("2026-11-17", "", "measure out/2026/result.json examples/platinum/check-bars.csv -o out/housing-17.csv"),
    ("2026-11-17", "", "record add out/housing-17.csv --arm P7 --at 2026-11-17T14:20"),
    ("2026-11-18", "year-trend.txt", 'record trend P7 E_Uni --artefact "bar front"'),
    ("2026-11-18", "", 'record event P7 quarantine "the check before work is out of control"'),
    ("2026-11-18", "year-impact.txt", "record impact P7"),
    ("2026-11-19", "", "simulate examples/platinum/next-year.toml -o out/next-year"),
    ("2026-11-19", "", "calibrate out/next-year/study.toml -o out/again"),
    (
        "2026-11-19",
        "",
        "record add out/again/result.json --arm P7 --at 2026-11-19 --study out/next-year/study.toml --on KB-443",
    ),
    ("2026-11-19", "year-compare.txt", "record compare P7"),
    (
        "2026-11-19",
        "",
        'record event P7 knock "the cleaner says that it fell against the table on the 17th" --at 2026-11-17',
    ),
    ("2026-11-19", "", 'record event P7 release "calibrated anew"'),
    (
        "2026-11-20",
        "",
        "record issue P7 examples/platinum/laboratory.toml --number EX-2026-0099 --supersedes EX-2026-0042 "
        '--reason "the arm was knocked on the 17th" --approved-by "Erika Muster"',
    ),
    ("2026-11-20", "year-interval.txt", "record interval P7"),
    ("2026-11-20", "year-history.txt", "record history P7"),
    ("2026-11-30", "year-verify.txt", "record verify"),
    ("2026-11-30", "year-backup.txt", "record backup out/backups"),
]
_HASH = re.compile(r"(?<=\()[0-9a-f]{8}(?=\))|[0-9a-f]{12}(?=…|\.zip)|\b[0-9a-f]{64}\b")


@contextmanager
def _as_in_the_year(folder: Path) -> Iterator[mock.Mock]:
    """The record's clock, and who works where."""
    settings = {"ULNA_RECORDS": "bench", "ULNA_BY": "Jan Beispiel", "XDG_CONFIG_HOME": str(folder / "config")}
    with mock.patch("ulna.records.chain.now") as clock, mock.patch.dict(os.environ, settings):
        yield clock


def year_outputs() -> dict[str, str]:
    """File name → what the command prints, the prompt's line first. Raises RuntimeError where one cannot be used."""
    found, others = {}, _Others()
    with reader_folder() as folder, _as_in_the_year(folder) as clock:
        for hour, (day, name, command) in enumerate(YEAR):
            clock.return_value = f"{day}T{8 + hour // 10:02}:{hour % 60:02}:00.000000+00:00"
            done = ulna([part.strip('"') for part in re.findall(r'"[^"]*"|\S+', command)], folder)
            if done.returncode not in (0, 1) and name != "year-refused.txt":
                raise RuntimeError(f"ulna {command} exited with {done.returncode}:\n{done.stderr}")
            if name:
                said = (done.stdout + done.stderr).replace(f"{folder}/", "/srv/").replace(str(folder), "/srv")
                found[name] = _HASH.sub(others, said)
    return found


class _Others:
    """Hashes of the same length, the same for the same beginning, in the order in which they appear."""

    def __init__(self) -> None:
        self._known: dict[str, int] = {}

    def __call__(self, found: re.Match[str]) -> str:
        number = self._known.setdefault(found[0][:8], len(self._known))
        return hashlib.sha256(str(number).encode()).hexdigest()[: len(found[0])]
