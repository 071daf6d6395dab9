"""Published files that loaders refuse or bend: what ikgen says of each, or reads of it.

The collection lies where `benchmarks/collection.py` says.
"""

from __future__ import annotations

import json

import pytest
from benchmarks.collection import ABSENT, CORPUS

from ikgen.chains.selection import select_chain
from ikgen.errors import BadDescriptionError
from ikgen.importers import load_tree

TRAPS = CORPUS / "traps"
pytestmark = pytest.mark.skipif(not (TRAPS / "manifest.json").is_file(), reason=ABSENT)

REFUSED = {
    "comma_numbers_bike": (
        20,
        "xyz: '0.07,' in '0.07, 0, -0.69' is not a number",
        "without commas",
    ),
    "dup_base_link_hebi_rosie": (118, "duplicate link 'base_link', first at line 2", "rename"),
    "junk_char_mycobot_pro_600_moveit": (11, "not well-formed XML", "merge conflict"),
    "multi_root_falcon": (
        39,
        "names the child link 'Z_propeller', which is not defined",
        "FR_prop",
    ),
    "optenv_left_husky": (97, "is a xacro expression", "rename it to .urdf.xacro"),
    "spherical_joint_hinge": (6, "the unknown type 'spherical'", "three revolute joints"),
    "two_parents_sda10f_test": (330, "'my_prefix_torso_base_link' has two parents", "remove one"),
}
READ = {
    "limit_without_range_quadruped": (12, "joint 'FL_KFE': no lower and upper limit"),
    "mimic_missing_alex_psyonic": (62, None),
    "negative_effort_ar4": (8, "joint 'joint_1': negative effort limit -1 ignored"),
    "prismatic_axis_not_unit_r1pro": (12, "lower = upper = 0: taken as unlimited"),
}


def test_every_trap_is_here():
    files = {row["file"] for row in json.loads((TRAPS / "manifest.json").read_text())}
    assert files == {f"{name}.urdf" for name in (*REFUSED, *READ)}


@pytest.mark.parametrize("name", REFUSED)
def test_refused_with_line_and_way_out(name):
    line, message, hint = REFUSED[name]
    file = TRAPS / f"{name}.urdf"
    with pytest.raises(BadDescriptionError) as caught:
        load_tree(file)
    assert (caught.value.file, caught.value.line) == (str(file), line)
    assert message in caught.value.message and hint in caught.value.hint


@pytest.mark.parametrize("name", READ)
def test_read_with_a_warning(name):
    joints, warning = READ[name]
    tree = load_tree(TRAPS / f"{name}.urdf")
    assert len(tree.joints) == joints
    warnings = tree.source.warnings
    assert not warnings if warning is None else any(warning in one for one in warnings)


def test_a_mimic_of_nothing_is_refused_where_it_is_in_the_chain():
    tree = load_tree(TRAPS / "mimic_missing_alex_psyonic.urdf")
    with pytest.raises(
        BadDescriptionError, match=r":\d+: joint '\w+' mimics '\w+', which does not"
    ):
        for joint in tree.joints:
            if joint.mimic is not None:
                select_chain(tree, joint.parent, joint.child)
