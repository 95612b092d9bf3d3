"""Migrates a record by the versions of a folder; to be killed.

python -m tests.records.migrating BENCH VERSIONS
"""

from __future__ import annotations

import sys
from pathlib import Path

import alembic.command  # loaded now, so that a kill hits what is done and not what is loaded
import alembic.config

from ulna.records.bench import Bench
from ulna.records.rebuild import index_anew
from ulna.records.schema import upgrade

if __name__ == "__main__":
    bench = Bench(Path(sys.argv[1]), "writer")
    print(alembic.config.__name__, alembic.command.__name__, flush=True)
    with bench.database.writing() as connection:
        upgrade(connection, Path(sys.argv[2]))
        index_anew(connection, bench.files)
