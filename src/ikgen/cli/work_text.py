"""How a job went, for -v: the derivation and what the checks found, of one that failed too."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ikgen.errors import IkgenError, UnsolvedChainError, VerificationError

if TYPE_CHECKING:
    from ikgen.generation.generate import Generation

__all__ = ["work_text"]


def work_text(done: Generation | IkgenError) -> str:
    """The derivation and the checks of what was generated, or how far the work came before an error;
    "" where it did not begin."""
    from ikgen.cli.tables import verification_tables
    from ikgen.cli.trace_text import derivation_trace

    parts: list[str] = []
    if isinstance(done, UnsolvedChainError):
        if done.unsolved is not None:
            parts.append(derivation_trace(done.unsolved.graph))
        parts += done.details
    elif isinstance(done, VerificationError):
        if done.derivation is not None:
            parts.append(derivation_trace(done.derivation.graph))
        parts.append(verification_tables(done.reports))
    elif not isinstance(done, IkgenError):
        parts = [derivation_trace(done.derivation.graph), verification_tables(done.reports)]
    return "\n".join(parts)
