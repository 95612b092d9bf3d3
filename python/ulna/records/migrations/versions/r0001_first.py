"""The first schema: the chain, and the index."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "r0001"
down_revision = None
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Make every table."""
    op.create_table(
        "calibration",
        sa.Column("seq", sa.Integer(), primary_key=True, autoincrement=False),
        sa.Column("line", sa.Integer(), primary_key=True, autoincrement=False),
        sa.Column("arm", sa.Text(), nullable=False),
        sa.Column("sha256", sa.Text(), nullable=False),
        sa.Column("at", sa.Text(), nullable=False),
        sa.Column("termination", sa.Text(), nullable=False),
        sa.Column("converged", sa.Boolean(), nullable=False),
        sa.Column("cost", sa.Double()),
        sa.Column("degrees_of_freedom", sa.Double()),
        sa.Column("version", sa.Text()),
    )
    op.create_index("calibration_arm_at", "calibration", ["arm", "at"])
    op.create_index("calibration_sha256", "calibration", ["sha256"])
    op.create_table(
        "certificate",
        sa.Column("seq", sa.Integer(), primary_key=True, autoincrement=False),
        sa.Column("line", sa.Integer(), primary_key=True, autoincrement=False),
        sa.Column("number", sa.Text(), nullable=False),
        sa.Column("arm", sa.Text(), nullable=False),
        sa.Column("sha256", sa.Text(), nullable=False),
        sa.Column("issued_at", sa.Text(), nullable=False),
        sa.Column("issued_by", sa.Text(), nullable=False),
        sa.Column("head", sa.Text(), nullable=False),
        sa.Column("approved_by", sa.Text()),
        sa.Column("supersedes", sa.Text()),
        sa.Column("of", sa.Text()),
    )
    op.create_index("certificate_arm_issued_at", "certificate", ["arm", "issued_at"])
    op.create_index("certificate_number", "certificate", ["number"])
    op.create_table(
        "certified",
        sa.Column("seq", sa.Integer(), primary_key=True, autoincrement=False),
        sa.Column("line", sa.Integer(), primary_key=True, autoincrement=False),
        sa.Column("artefact", sa.Text(), nullable=False),
        sa.Column("quantity", sa.Text(), nullable=False),
        sa.Column("unit", sa.Text(), nullable=False),
        sa.Column("value", sa.Double(), nullable=False),
        sa.Column("u", sa.Double(), nullable=False),
        sa.Column("temperature_c", sa.Double()),
        sa.Column("expansion_per_k", sa.Double()),
        sa.Column("expansion_u_per_k", sa.Double()),
        sa.Column("number", sa.Text()),
        sa.Column("by", sa.Text()),
        sa.Column("sha256", sa.Text()),
        sa.Column("valid_from", sa.Text()),
        sa.Column("valid_to", sa.Text()),
    )
    op.create_index("certified_artefact_quantity_seq", "certified", ["artefact", "quantity", "seq"])
    op.create_table(
        "entry",
        sa.Column("seq", sa.Integer(), primary_key=True, autoincrement=False),
        sa.Column("at", sa.String(), nullable=False),
        sa.Column("actor", sa.String(), nullable=False),
        sa.Column("act", sa.String(), nullable=False),
        sa.Column("subject", sa.String(), nullable=False),
        sa.Column("previous", sa.String(), nullable=False),
        sa.Column("sha256", sa.String(), nullable=False, unique=True),
        sa.Column("text", sa.Text(), nullable=False),
    )
    op.create_index("entry_subject", "entry", ["subject", "seq"])
    op.create_table(
        "equipment",
        sa.Column("seq", sa.Integer(), primary_key=True, autoincrement=False),
        sa.Column("line", sa.Integer(), primary_key=True, autoincrement=False),
        sa.Column("name", sa.Text(), nullable=False),
        sa.Column("kind", sa.Text(), nullable=False),
        sa.Column("state", sa.Text(), nullable=False),
        sa.Column("part_of", sa.Text()),
        sa.Column("maker", sa.Text()),
        sa.Column("model", sa.Text()),
        sa.Column("serial", sa.Text()),
        sa.Column("firmware", sa.Text()),
        sa.Column("owner", sa.Text()),
        sa.Column("location", sa.Text()),
        sa.Column("remark", sa.Text()),
    )
    op.create_index("equipment_kind", "equipment", ["kind"])
    op.create_index("equipment_name_seq", "equipment", ["name", "seq"])
    op.create_table(
        "event",
        sa.Column("seq", sa.Integer(), primary_key=True, autoincrement=False),
        sa.Column("line", sa.Integer(), primary_key=True, autoincrement=False),
        sa.Column("equipment", sa.Text(), nullable=False),
        sa.Column("kind", sa.Text(), nullable=False),
        sa.Column("at", sa.Text(), nullable=False),
        sa.Column("text", sa.Text(), nullable=False),
    )
    op.create_index("event_equipment_at", "event", ["equipment", "at"])
    op.create_table(
        "figure",
        sa.Column("seq", sa.Integer(), primary_key=True, autoincrement=False),
        sa.Column("line", sa.Integer(), primary_key=True, autoincrement=False),
        sa.Column("arm", sa.Text(), nullable=False),
        sa.Column("sha256", sa.Text(), nullable=False),
        sa.Column("source", sa.Text(), nullable=False),
        sa.Column("at", sa.Text(), nullable=False),
        sa.Column("state", sa.Text(), nullable=False),
        sa.Column("name", sa.Text(), nullable=False),
        sa.Column("unit", sa.Text(), nullable=False),
        sa.Column("artefact", sa.Text()),
        sa.Column("value", sa.Double(), nullable=False),
        sa.Column("u", sa.Double()),
        sa.Column("k", sa.Double()),
        sa.Column("limit_value", sa.Double()),
        sa.Column("verdict", sa.Text()),
    )
    op.create_index("figure_arm_name_at", "figure", ["arm", "name", "at"])
    op.create_index("figure_sha256", "figure", ["sha256"])
    op.create_table(
        "file",
        sa.Column("seq", sa.Integer(), primary_key=True, autoincrement=False),
        sa.Column("line", sa.Integer(), primary_key=True, autoincrement=False),
        sa.Column("sha256", sa.Text(), nullable=False),
        sa.Column("name", sa.Text()),
        sa.Column("format", sa.Text()),
        sa.Column("role", sa.Text(), nullable=False),
    )
    op.create_index("file_sha256", "file", ["sha256"])
    op.create_table(
        "interval",
        sa.Column("seq", sa.Integer(), primary_key=True, autoincrement=False),
        sa.Column("line", sa.Integer(), primary_key=True, autoincrement=False),
        sa.Column("equipment", sa.Text(), nullable=False),
        sa.Column("days", sa.Double(), nullable=False),
        sa.Column("method", sa.Text(), nullable=False),
        sa.Column("from_at", sa.Text(), nullable=False),
        sa.Column("due_at", sa.Text(), nullable=False),
        sa.Column("why", sa.Text()),
    )
    op.create_index("interval_due_at", "interval", ["due_at"])
    op.create_index("interval_equipment_seq", "interval", ["equipment", "seq"])
    op.create_table(
        "parameter",
        sa.Column("seq", sa.Integer(), primary_key=True, autoincrement=False),
        sa.Column("line", sa.Integer(), primary_key=True, autoincrement=False),
        sa.Column("arm", sa.Text(), nullable=False),
        sa.Column("sha256", sa.Text(), nullable=False),
        sa.Column("at", sa.Text(), nullable=False),
        sa.Column("name", sa.Text(), nullable=False),
        sa.Column("unit", sa.Text(), nullable=False),
        sa.Column("status", sa.Text(), nullable=False),
        sa.Column("value", sa.Double(), nullable=False),
        sa.Column("u", sa.Double()),
    )
    op.create_index("parameter_arm_name_at", "parameter", ["arm", "name", "at"])
    op.create_index("parameter_sha256", "parameter", ["sha256"])
    op.create_table(
        "person",
        sa.Column("seq", sa.Integer(), primary_key=True, autoincrement=False),
        sa.Column("line", sa.Integer(), primary_key=True, autoincrement=False),
        sa.Column("name", sa.Text(), nullable=False),
        sa.Column("roles", sa.Text(), nullable=False),
    )
    op.create_index("person_name_seq", "person", ["name", "seq"])
    op.create_table(
        "setting",
        sa.Column("seq", sa.Integer(), primary_key=True, autoincrement=False),
        sa.Column("line", sa.Integer(), primary_key=True, autoincrement=False),
        sa.Column("name", sa.Text(), nullable=False),
        sa.Column("value", sa.Text(), nullable=False),
    )
    op.create_index("setting_name_seq", "setting", ["name", "seq"])
    op.create_table(
        "standing",
        sa.Column("seq", sa.Integer(), primary_key=True, autoincrement=False),
        sa.Column("line", sa.Integer(), primary_key=True, autoincrement=False),
        sa.Column("subject", sa.Text(), nullable=False),
        sa.Column("state", sa.Text(), nullable=False),
        sa.Column("reason", sa.Text(), nullable=False),
    )
    op.create_index("standing_subject_seq", "standing", ["subject", "seq"])
    op.create_table(
        "used",
        sa.Column("seq", sa.Integer(), primary_key=True, autoincrement=False),
        sa.Column("line", sa.Integer(), primary_key=True, autoincrement=False),
        sa.Column("sha256", sa.Text(), nullable=False),
        sa.Column("arm", sa.Text(), nullable=False),
        sa.Column("artefact", sa.Text(), nullable=False),
        sa.Column("at", sa.Text(), nullable=False),
    )
    op.create_index("used_artefact_at", "used", ["artefact", "at"])
