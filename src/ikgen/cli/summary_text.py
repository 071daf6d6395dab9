"""What a finished generation says to people."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ikgen.cli.tables import table
from ikgen.generation.result import branches_beside, default_words, rounding, task_words
from ikgen.model.counted import counted, listed

if TYPE_CHECKING:
    from ikgen.emit.derivation import Derivation
    from ikgen.generation.generate import Generation
    from ikgen.model.dh import DHChain
    from ikgen.verify.verification_report import VerificationReport

__all__ = ["summary"]


def summary(generation: Generation) -> str:
    """The result in a few lines."""
    derivation = generation.derivation
    module, dh = derivation.module, derivation.reading.dh
    lines = [
        ("robot", _robot(derivation)),
        ("task", task_words(derivation) + _held(derivation)),
        ("geometry", derivation.geometry.words + _rounding(derivation)),
        ("solved", "; ".join(module.order)),
        *_coupled(derivation),
        *_motors(dh),
        *_calibration(derivation),
        ("solutions", _solutions(generation)),
    ]
    lines += [("verified", _verified(name, r)) for name, r in generation.reports.items()]
    if not generation.reports:
        lines.append(("verified", "no"))
    if dh.symbols:
        words = "; verified with sample numbers" if generation.reports else ""
        lines.append(("fill in", f"{dh.symbol_words}{words}"))
    lines += _manifest(generation)
    lines += [("wrote", str(path)) for path in generation.files]
    lines.append(("time", f"{generation.seconds:.1f} s"))
    return table([(f"{name}:", text) for name, text in lines], indent="")


def _manifest(generation: Generation) -> list[tuple[str, str]]:
    """What the manifest of a ROS package has no more than a placeholder for."""
    module = generation.derivation.module
    values = ("maintainer", module.maintainer), ("license", module.license)
    missing = [name for name, value in values if value is None]
    manifest = next((path for path in generation.files if path.name == "package.xml"), None)
    if manifest is None or not missing:
        return []
    options = ", ".join(f"--{name}" for name in missing)
    return [("fill in", f"{' and '.join(missing)} of {manifest} ({options})")]


def _robot(derivation: Derivation) -> str:
    """The chain, and the branches beside it where it was taken for the robot's only arm."""
    dh = derivation.reading.dh
    words = f"{dh.robot}, {dh.base_link} -> {dh.tip_link}, {counted(dh.dof, 'joint')}"
    others = branches_beside(derivation)
    return f"{words}; other branches end at {listed(others, 5)} (--tip)" if others else words


def _coupled(derivation: Derivation) -> list[tuple[str, str]]:
    """Lines on the joints that follow others, as the file says and beyond that, and how."""
    reading = derivation.reading
    why = " (equal stages of a telescope)" if reading.coupled else ""  # which come last
    beyond = [("coupled", "; ".join(reading.relations) + why)] if reading.relations else []
    own = reading.followers
    return [("follow", f"{'; '.join(own)} (as in the file)"), *beyond] if own else beyond


def _motors(dh: DHChain) -> list[tuple[str, str]]:
    """A line on the motors whose values the solver takes, where these are not the joints'."""
    if dh.transmission is None:
        return []
    return [("motors", "; ".join(dh.transmission.words([joint.name for joint in dh.joints])))]


def _calibration(derivation: Derivation) -> list[tuple[str, str]]:
    """That the chain is one arm's own, and how far that is off the model."""
    found = derivation.reading.calibration
    return [] if found is None else [("calibrated", found.words)]


def _held(derivation: Derivation) -> str:
    """What is held, and that the rest cannot do all of the task, or hardly moves."""
    from ikgen.derivation.idle_solved import idle_solved
    from ikgen.kinematics.idle_joints import lock_options
    from ikgen.tasks.fitting import over_constrained

    held, idle = derivation.reading.dh.held, idle_solved(derivation.reading.dh, derivation.task)
    words = f", held: {', '.join(held)}" if held else ""
    if idle:
        names = " and ".join(joint.name for joint in idle)
        verb, them = (
            ("hardly move", "their values") if len(idle) > 1 else ("hardly moves", "its value")
        )
        words += f"; {names} {verb}: answers only poses with {them} ({lock_options(idle)})"
    if not over_constrained(derivation.reading.dh, derivation.task):
        return words
    return f"{words}; OVER-CONSTRAINED, answers only poses that the arm can take to rounding"


def _rounding(derivation: Derivation) -> str:
    """How far the file is off what was solved, where Newton steps take the rows to it; its class where that
    is another."""
    named = derivation.file_class
    other = f", {named}," if named and named != derivation.geometry.name else ""
    off = rounding(derivation)
    if off is None:
        return other and f"; the file's is {named}"
    far = f"{1e3 * off[0]:.2g} mm and {off[1]:.1g} rad off"
    return f"; the file's{other} is up to {far}, its rows are exact"


def _solutions(generation: Generation) -> str:
    """How many solutions there are at most, and over the random poses."""
    most = f"at most {generation.derivation.module.max_solutions}"
    for report in generation.reports.values():
        least, mean, greatest = report.solutions
        found = f"{least} / {mean:.1f} / {greatest} (min / mean / max of random poses)"
        default = default_words(generation)
        return f"{most}; {found}{'; ' * bool(default)}{default}"
    return most


def _verified(name: str, report: VerificationReport) -> str:
    metres, radians = report.worst_closure
    return (
        f"{name}: {report.samples} poses, worst closure {metres:.1e} m {radians:.1e} rad, "
        f"{report.missed_words}, {report.seconds:.1f} s"
    )
