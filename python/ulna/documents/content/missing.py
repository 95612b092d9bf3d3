"""What a section lacks, and what would be needed: said, never passed over."""

from __future__ import annotations

from ulna.documents.content.content import Content
from ulna.documents.languages.said import Said


def missing_parts(content: Content, no_study: Said | None, held_out: bool) -> dict[str, Said]:
    """Section → what it lacks. no_study: where the study is not known; held_out: whether such readings are."""
    missing = {} if no_study is None else {"study": no_study}
    lacking = {
        "verification": content.verification is None,
        "laboratory": content.laboratory is None,
        "joint": no_study is None and all(cloud.over != "joint" for cloud in content.clouds),
        "temperature": no_study is None and all(cloud.over != "temperature" for cloud in content.clouds),
        "lengths": no_study is None and content.lengths is None,
        "quiver": no_study is None and content.quiver is None,
        "correlation": not content.parameters.correlation_names,
        "observability": content.observability is None,
    }
    if not held_out:
        missing["held-out"] = Said("held-out.none")
    return missing | {key: Said(f"missing.{key}") for key, lacks in lacking.items() if lacks}
