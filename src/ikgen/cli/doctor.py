"""`ikgen doctor`: which tools and plug-ins there are, and how to get what is missing."""

from __future__ import annotations

import json
import sys

import click

from ikgen import __version__
from ikgen.cli.error_output import as_object
from ikgen.cli.tables import table
from ikgen.generation.checkup import Offer, Thing, offers, packages, tools
from ikgen.plugins import GROUPS

__all__ = ["doctor"]


@click.command()
@click.option("--json", "as_json", is_flag=True, help="Machine-readable result on stdout.")
def doctor(as_json: bool) -> int:
    """Say which packages, tools and plug-ins there are; exit code 1 if a needed package is missing
    or a plug-in is broken."""
    needed, optional, others = packages(), tools(), offers()
    bad = [f"{t.name} is missing" for t in needed if t.found is None]
    bad += [f"{o.plug_in.words} {o.problem}" for o in others if o.problem]
    if as_json:
        hint = "\n".join(t.remedy for t in needed if t.found is None)
        error = {"error": as_object("; ".join(bad), hint, 1)} if bad else {}
        click.echo(json.dumps({**_record(needed, optional, others), **error}, indent=2))
    else:
        click.echo(_text(needed, optional, others))
    return 1 if bad else 0


def _record(needed: list[Thing], optional: list[Thing], others: list[Offer]) -> dict[str, object]:
    return {
        "ikgen": __version__,
        "python": sys.version.split()[0],
        "packages": {thing.name: thing.found for thing in needed},
        "tools": {thing.name: thing.found for thing in optional},
        "plug_ins": [
            {
                "kind": GROUPS[o.plug_in.group],
                "name": o.plug_in.name,
                "target": o.plug_in.target,
                "package": o.plug_in.package,
                "problem": o.problem or None,
            }
            for o in others
        ],
    }


def _text(needed: list[Thing], optional: list[Thing], others: list[Offer]) -> str:
    rows: list[tuple[str, ...]] = [
        ("ikgen", "", __version__),
        ("python", "", sys.version.split()[0]),
    ]
    rows += [_row(thing, "MISSING") for thing in needed]
    rows += [_row(thing, "not found") for thing in optional]
    parts = [table(rows, indent="")]
    if others:
        listed = [
            (
                f"{GROUPS[o.plug_in.group]} '{o.plug_in.name}'",
                o.plug_in.package,
                o.plug_in.target,
            )
            for o in others
        ]
        parts.append("from other packages:\n" + table(listed))
    parts += [f"{o.plug_in.words} {o.problem}" for o in others if o.problem]
    return "\n\n".join(parts)


def _row(thing: Thing, missing: str) -> tuple[str, str, str]:
    """What was found comes last: paths are as long as they are."""
    found = f"{missing}; {thing.remedy}" if thing.found is None else thing.found
    return thing.name, thing.purpose, found
