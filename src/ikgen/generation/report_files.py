"""The derivation report of a robot: its texts, and PDFs of them where LaTeX is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ikgen.derivation.derive import derive
from ikgen.derivation.progress import Progress, silent
from ikgen.errors import IkgenError, UnsolvedChainError, VerificationError
from ikgen.generation.emitted_checks import verify_texts, with_samples
from ikgen.outputs.publish import Content, check_folder
from ikgen.outputs.written_list import publish_listed

if TYPE_CHECKING:
    from ikgen.emit.derivation import Derivation
    from ikgen.records.request import Outputs, Request
    from ikgen.verify.verification_report import VerificationReport

__all__ = ["ReportFiles", "write_report"]


@dataclass(frozen=True, slots=True)
class ReportFiles:
    """What was written, warnings, and the error to end with: of an arm without a closed form, or of a
    verification that failed. Either is in the report."""

    files: tuple[Path, ...]
    warnings: tuple[str, ...] = ()
    wrong: IkgenError | None = None


def write_report(request: Request, outputs: Outputs, progress: Progress = silent) -> ReportFiles:
    """Write how the inverse kinematics was derived into the outputs' folder, and what else they name.
    Raises `UsageError` where files that ikgen did not write, or that were edited, would be replaced."""
    check_folder(outputs.out)
    name, texts, wrong = _texts(request, outputs, progress)
    pdfs, warnings = _pdfs(texts, progress)
    made: dict[str, Content] = {**texts, **pdfs}
    stale = _stale_pdfs(outputs.out, made)
    files = publish_listed(
        outputs.out, f"{name}_report", made, stale, arm=name, force=outputs.force
    )
    warnings += [f"removed {pdf}: it was made from an earlier report" for pdf in stale]
    return ReportFiles(files, tuple(warnings), wrong)


def _texts(
    request: Request, outputs: Outputs, progress: Progress
) -> tuple[str, dict[str, str], IkgenError | None]:
    """The arm's name, file name -> text of the report, and the error to end with."""
    from ikgen.derivation.remedies import helped
    from ikgen.generation.emitters import find_emitter
    from ikgen.report import emit_report, emit_unsolved

    try:
        derivation = derive(request, progress)
    except UnsolvedChainError as error:
        stuck = helped(error, request, progress)
        if stuck.unsolved is None:  # refused before anything was derived
            raise stuck from None
        return stuck.unsolved.name, emit_unsolved(stuck.unsolved, stuck.hint), stuck
    wrong = None
    try:
        reports = _verified(derivation, outputs, progress)
    except VerificationError as error:
        reports = error.reports
        wrong = VerificationError(
            error.message,
            reports=reports,
            derivation=derivation,
            hint="the report has all checks",
        )
    progress("emit", "report")
    texts = emit_report(derivation, reports)
    for name in dict.fromkeys(outputs.emit):
        texts |= find_emitter(name).emit(derivation)
    return derivation.module.name, texts, wrong


def _verified(
    derivation: Derivation, outputs: Outputs, progress: Progress
) -> Mapping[str, VerificationReport]:
    """The verification of the Python module."""
    from ikgen.generation.emitters import find_emitter

    if not outputs.verify:
        return {}
    sampled, python = with_samples(derivation), find_emitter("python")
    return verify_texts(sampled, [python], lambda one: one.emit(sampled), outputs, progress)


def _pdfs(texts: Mapping[str, str], progress: Progress) -> tuple[dict[str, bytes], list[str]]:
    """File name -> PDF of the LaTeX texts, where LaTeX is installed; warnings where it fails."""
    from ikgen.report.pdf import has_latex, typeset

    made, warnings = {}, []
    for name, text in texts.items() if has_latex() else ():
        if name.endswith(".tex"):
            progress("typeset", name)
            result = typeset(name, text)
            if result.pdf is not None:
                made[str(Path(name).with_suffix(".pdf"))] = result.pdf
            else:
                warnings.append(f"no PDF of {name}: {result.failure}")
    return made, warnings


def _stale_pdfs(out: Path, made: Mapping[str, Content]) -> list[Path]:
    """PDFs that are there, are not made anew, and whose LaTeX text is about to change."""
    found = []
    for name, content in made.items():
        tex, pdf = out / name, (out / name).with_suffix(".pdf")
        lacks = name.endswith(".tex") and str(Path(name).with_suffix(".pdf")) not in made
        if lacks and pdf.is_file():
            earlier = tex.read_text(encoding="utf-8") if tex.is_file() else None
            found += [pdf] if earlier != content else []
    return found
