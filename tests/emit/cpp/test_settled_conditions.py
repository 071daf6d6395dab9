"""Text of the C++ runtime without what `if constexpr` leaves out for one arm."""

from __future__ import annotations

import pytest

from ikgen.emit.cpp.settled_conditions import without_other_arms

FACTS = (("kNewton", True), ("kRefined", False), ("kBesides", False))


@pytest.mark.parametrize(
    ("text", "left"),
    [
        ("  if constexpr (Arm::kNewton) {\n    a();\n    b();\n  }\n", "  a();\n  b();\n"),
        ("  if constexpr (Arm::kRefined) a(1, {2});\n  b();\n", "  b();\n"),
        ("  if constexpr (!Arm::kRefined) a();\n", "  a();\n"),
        ("  if constexpr (A::kNewton)\n    if (x) a();\n  b();\n", "  if (x) a();\n  b();\n"),
        ("  if constexpr (Arm::kBesides > 0) {\n    a();\n  } else {\n    b();\n  }\n", "  b();\n"),
        (
            "  if constexpr (Arm::kRefined) {\n    a();\n  } else if (x) {\n    b();\n  }\n",
            "  if (x) {\n    b();\n  }\n",
        ),
        (
            "  if constexpr (Arm::kRefined) {\n    a();\n  } else if constexpr (Arm::kNewton) {\n"
            "    b();\n  } else {\n    c();\n  }\n",
            "  b();\n",
        ),
        (
            "  if constexpr (Arm::kNewton) {\n    if constexpr (Arm::kRefined) a();\n    b();\n  }\n",
            "  b();\n",
        ),
        ("  if constexpr (Arm::kUnknown && Arm::kRefined) a();\n  b();\n", "  b();\n"),
        ('  if constexpr (Arm::kRefined) {\n    a("}");  // }\n  }\n  b();\n', "  b();\n"),
        (
            "  if constexpr (Arm::kRefined)\n    for (int i : x)\n      if (i) a(); else b();\n  c();\n",
            "  c();\n",
        ),
    ],
)
def test_what_is_known_is_decided(text: str, left: str) -> None:
    assert without_other_arms(text, FACTS) == left


@pytest.mark.parametrize(
    "text",
    [
        "  if constexpr (Arm::kUnknown) a();\n",
        "  if constexpr (Arm::kNewton && N > 3) a();\n",
        "  if (Arm::kRefined) a();\n",
        "  if constexpr (Plan::kNewton) a();\n",
    ],
)
def test_what_is_not_known_stays(text: str) -> None:
    assert without_other_arms(text, FACTS) == text
