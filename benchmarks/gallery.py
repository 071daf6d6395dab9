"""Fifty robots of the collection: what ikgen makes of each, drawn and measured.

    python -m benchmarks.gallery [--arm NAME] [--executor process|dask] [--workers N] [--record]
    python -m benchmarks.gallery --page | --reports SITE

Prints a line an arm. `--record` writes `results/gallery.json`, the drawings in `docs/pictures/gallery/` and
the page `docs/gallery.md`; `--page` makes the page alone from what was recorded. `--reports` writes the
report of each into the built documentation SITE and links it there. Seconds are processor time.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.collection import ABSENT, CORPUS, load_arms, urdf_of
from benchmarks.gallery_page import PAGE, PICTURES, page, with_reports
from benchmarks.results import read_result, write_result
from ikgen.derivation.derive import derive
from ikgen.processes.executors import EXECUTORS, Workers, run_pieces
from ikgen.records.request import Request
from ikgen.report import emit_report
from ikgen.report.skeleton import Style, skeleton_svg
from ikgen.report.worked_example import shown_configuration, solver_of

__all__ = ["ROBOTS", "Shown", "show"]

ROBOTS = (
    "abb_irb120", "abb_irb2400", "abb_irb6700_200_260", "hyundai_hh020", "agilex_piper", "annin_ar4_mk3",
    "denso_vs060", "doosan_m1013", "fanuc_m20ia10l", "igus_rebel_6dof", "kinova_j2s6s300",
    "kuka_kr6r900sixx", "kuka_kr210_r2700_2", "kuka_iisy3_r760", "lite6", "mitsubishi_rv5as",
    "motoman_gp7", "staubli_tx60", "ur3e", "ur5e", "ur10e", "techman_tm12", "mycobot280_m5",
    "standardbots_core", "i2rt_yam", "arx_r5", "fanuc_crx10ia", "kinova_j2n6s300", "xarm6",
    "motoman_hc10", "schunk_lwa4p", "bravo7", "kuka_iiwa14_lbr", "openarm_left", "franka_fr3",
    "kinova_gen3_7dof", "abb_yumi_left", "baxter_left", "sawyer", "flexiv_rizon10", "talos_left_arm",
    "unitree_h1_2_left_arm", "tiago_torso_arm", "so101", "interbotix_vx250", "fanuc_lrmate200ic5h",
    "igus_robolink_rl_dp_5", "open_manipulator_x", "mitsubishi_rh6frh5520_scara", "allegro_thumb",
)  # fmt: skip
"""Names in the collection, by class."""

_POSES, _ENOUGH = 400, 0.3
_STYLE = Style(200, 160, named=False)


@dataclass(frozen=True, slots=True)
class Shown:
    """One robot: its class, task, held joints and solutions a pose (`most`, `mean`); `seconds` to derive
    it, `microseconds` a pose of the emitted Python module in batches; `source` is where its file is."""

    name: str
    family: str
    joints: int
    task: str
    held: list[str]
    most: int
    mean: float
    seconds: float
    microseconds: float
    source: str
    file: str
    base: str
    tip: str


def show(job: tuple[dict[str, Any], bool]) -> tuple[Shown, str]:
    """The robot of a row of the collection, and its drawing; with the flag its report instead."""
    arm, report = job
    with tempfile.TemporaryDirectory() as folder:
        path = CORPUS / arm["file"] if arm.get("file") else Path(folder, f"{arm['name']}.urdf")
        if not arm.get("file"):
            path.write_text(urdf_of(arm), encoding="utf-8")
        start = time.process_time()
        found = derive(Request(path, base=arm["base_link"], tip=arm["tip_link"]))
        seconds = time.process_time() - start
    dh, solver = found.reading.dh, solver_of(found)
    assert solver is not None
    mean, microseconds = _timed(solver)
    shown = Shown(
        arm["name"], found.geometry.words.partition(": ")[0], dh.dof, found.task.name,
        list(dh.free), found.module.max_solutions, mean, round(seconds, 2), microseconds,
        f"{arm['source_repo']}/blob/{arm['source_commit']}/{arm['source_path']}",
        Path(arm["source_path"]).name, dh.base_link, dh.tip_link,
    )  # fmt: skip
    if report:
        texts = emit_report(found)
        return shown, next(text for name, text in texts.items() if name.endswith(".html"))
    q = shown_configuration(dh)
    return shown, skeleton_svg(dh, q, style=_STYLE, title=f"{arm['name']} as a skeleton")


def _timed(solver: Any) -> tuple[float, float]:
    """Mean solutions of reachable poses, limits disregarded, and microseconds a pose."""
    constants = solver.constants
    low, high = np.maximum(constants.lower, -np.pi), np.minimum(constants.upper, np.pi)
    rng = np.random.default_rng(5)
    q = rng.uniform(low, np.maximum(low, high), (_POSES, len(low)))
    poses, held = solver.forward(q), [constants.joint_names.index(n) for n in constants.free_joints]
    free = {"free": q[:, held]} if held else {}
    times, counts = [], np.zeros(1)
    while sum(times) < _ENOUGH or len(times) < 2:
        start = time.process_time()
        counts = solver.module.solve_batch(poses, limits=False, **free)[1]
        times.append(time.process_time() - start)
    return round(float(counts.mean()), 2), float(f"{1e6 * min(times) / _POSES:.2g}")


def main(arguments: Sequence[str] | None = None) -> int:
    """Show the robots; 2 where the collection is absent."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--arm", action="append", default=[], help="only this robot (repeatable)")
    parser.add_argument("--executor", choices=EXECUTORS, default="process")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--record", action="store_true", help="write record, drawings and page")
    parser.add_argument("--page", action="store_true", help="make the page from what was recorded")
    parser.add_argument(
        "--reports", type=Path, metavar="SITE", help="write the reports into a site"
    )
    options = parser.parse_args(arguments)
    if options.page:
        PAGE.write_text(page(read_result("gallery")), encoding="utf-8")
        return 0
    rows = {arm["name"]: arm for arm in load_arms()}
    if not rows:
        print(ABSENT, file=sys.stderr)
        return 2
    jobs = [(rows[name], options.reports is not None) for name in options.arm or ROBOTS]
    made = run_pieces(Workers(options.executor, options.workers), show, jobs, _told)
    if options.reports is not None:
        with_reports(options.reports, {shown.name: text for shown, text in made})
        return 0
    for shown, _ in made:
        held = f", {', '.join(shown.held)} held" if shown.held else ""
        print(f"{shown.name:28} {shown.family:36} {shown.mean:5.1f} of {shown.most:2}, "
              f"{shown.seconds:6.1f} s, {shown.microseconds:6.1f} us{held}")  # fmt: skip
    if options.record:
        _record(made)
    return 0


def _told(ready: int, total: int) -> None:
    print(f"{ready} of {total}", file=sys.stderr, flush=True)


def _record(made: Sequence[tuple[Shown, str]]) -> None:
    PICTURES.mkdir(exist_ok=True)
    for shown, drawing in made:
        (PICTURES / f"{shown.name}.svg").write_text(drawing, encoding="utf-8")
    found = {"robots": [asdict(shown) for shown, _ in made]}
    write_result("gallery", "python -m benchmarks.gallery", found)
    PAGE.write_text(page(read_result("gallery")), encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
