"""Write `page/openapi.json`: the contract of server and page, from the models of `ulna.serve.contract`.

    python tools/openapi.py

Each build of `page/` makes TypeScript of it.
"""

from __future__ import annotations

import json
from pathlib import Path

from ulna.serve.app import api

PATH = Path(__file__).resolve().parents[1] / "page" / "openapi.json"


def text() -> str:
    """The document. The version stays out: a release is no other contract."""
    document = api().openapi()
    return json.dumps({**document, "info": {**document["info"], "version": "1"}}, indent=1, sort_keys=True) + "\n"


def main() -> None:
    """Write it."""
    PATH.parent.mkdir(exist_ok=True)
    PATH.write_text(text(), encoding="utf-8")
    print(f"Written: {PATH.name}")


if __name__ == "__main__":
    main()
