"""The C++ runtime by its definitions: all of the text, each by its name, and what a name leads to."""

from __future__ import annotations

import pytest
from tests.support.runtime_files import HEADERS

from ikgen.emit.cpp.cpp_definitions import Definition, definitions, needed
from ikgen.emit.cpp.header_bundle import bundle

TEXT = """\
inline constexpr double kUsed = 1.0, kBeside = 2.0;
inline constexpr int kUnused[] = {1, 2};

template <class T, class = std::enable_if_t<(sizeof(T) > 0)>>
[[gnu::always_inline]] inline T twice(const T& x) noexcept {
  return x * (kUsed + '}');  // }
}
template <class T> inline T operator+(const T& a, const T& b) { return a; }
inline int alone() { return alone(); }

template <int N> struct Box {
  using Value = double;
  double q[N];
  Box() = default;
  explicit Box(double x) noexcept : q{x} {}
  static Value first(const Box& b) noexcept { return b.q[0]; }

  struct Inner {
    int count = 0;
    int size_of() const noexcept { return count; }
  };

 private:
  static int last(const Box& b) noexcept { return second(b); }
  static int second(const Box&) noexcept { return 0; }
};
"""


def all_of(one: Definition) -> str:
    return one.text + "".join(map(all_of, one.members)) + one.behind


def left(*wanted: str) -> str:
    found = list(definitions(TEXT))
    kept = needed(found, set(wanted))
    return "".join(one.without(kept) for one in found if id(one) in kept)


@pytest.mark.parametrize("header", HEADERS)
def test_the_runtime_is_all_there(header: str) -> None:
    text = bundle([header]).body
    assert "".join(map(all_of, definitions(text))) == text


def test_names() -> None:
    found = [sorted(one.names) for one in definitions(TEXT) if one.text.strip()]
    assert found == [["kBeside", "kUsed"], ["kUnused"], ["twice"], [], ["alone"], ["Box"]]


def test_a_name_leads_to_what_its_definition_names() -> None:
    text = left("twice")
    assert "kUsed" in text and "T twice(" in text
    assert "kUnused" not in text and "alone" not in text and "Box" not in text


def test_operators_stay() -> None:
    begin, end = TEXT.index("template <class T> inline T op"), TEXT.index("inline int alone")
    assert left().strip() == TEXT[begin:end].strip()


def test_of_a_class_its_data_and_constructors_stay_and_functions_that_are_named() -> None:
    text = left("Box", "first")
    assert "double q[N];" in text and "explicit Box(" in text and "Value first(" in text
    assert "using Value" in text
    assert "Inner" not in text and "last" not in text and "second" not in text
    assert "second" in left("Box", "last")
    assert "int count" in left("Box", "Inner") and "size_of" not in left("Box", "Inner")
