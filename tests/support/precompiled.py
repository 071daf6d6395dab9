"""A g++ that takes Eigen's headers precompiled: they are most of what it reads where tests compile."""

from __future__ import annotations

import hashlib
import os
import shlex
import subprocess
from pathlib import Path

from ikgen.errors import MissingToolError
from ikgen.verify.runners.cpp_toolchain import LEAN, find_compiler, find_eigen, is_gcc

__all__ = ["OPTIONS", "compilers"]

OPTIONS = "-std=c++17 -O1"
"""For what others compile: Eigen is precompiled for them."""

GARBAGE = "--param ggc-min-expand=400 --param ggc-min-heapsize=400000"
"""The compiler looks for garbage seldom: it takes a tenth more memory and a tenth less time."""

FOLDER = Path(__file__).parents[2] / "build" / "precompiled"
HEADERS = "#include <Eigen/Core>\n#include <Eigen/Geometry>\n"
SCRIPT = """#!/bin/sh
# {compiler}, with Eigen precompiled for options of ikgen's own compilations. Where others differ from those
# it was precompiled for, g++ reads the headers themselves; options of optimisation it takes from there.
case " $* " in
  *" -fsyntax-only "*) exec {compiler} {garbage} "$@" ;;
  *" -std=c++17"*" -O1 "*) ;;
  *) exec {compiler} {garbage} "$@" ;;
esac
strict= machine=  # other sets of predefined macros
case " $* " in *" -Wpedantic "*) strict=-Wpedantic ;; esac
case " $* " in *" -march=native "*) machine=-march=native ;; esac
made={header}.gch/light$strict$machine
if [ ! -f "$made" ]; then
  mkdir -p {header}.gch  # each process writes a file of its own
  {compiler} -std=c++17 -O1 {lean} $strict $machine -pthread -isystem {eigen} \\
    -x c++-header {header} -o {folder}/$$.gch && mv {folder}/$$.gch "$made"
fi
exec {compiler} {garbage} -pthread -include {header} "$@"
"""


def compilers() -> Path | None:
    """The folder of c++ and g++ to come first on PATH. None where CXX names a compiler, where that is not
    g++, or is this one already."""
    try:
        compiler, eigen = find_compiler(), find_eigen()
    except MissingToolError:
        return None
    version = subprocess.run([*compiler, "--version"], capture_output=True, text=True).stdout
    own = FOLDER in Path(compiler[0]).parents
    if own or "CXX" in os.environ or not is_gcc(tuple(compiler)):
        return None
    key = "\n".join([version, *compiler, str(eigen), HEADERS, SCRIPT, GARBAGE, *LEAN])
    folder = FOLDER / hashlib.sha256(key.encode()).hexdigest()[:16]
    header, script = folder / "eigen.hpp", folder / "bin" / "c++"
    if not script.is_file():
        script.parent.mkdir(parents=True, exist_ok=True)
        header.write_text(HEADERS)
        places = {"folder": folder, "header": header, "eigen": eigen, "compiler": compiler[0]}
        quoted = {name: shlex.quote(str(path)) for name, path in places.items()}
        text = SCRIPT.format(garbage=GARBAGE, lean=" ".join(LEAN), **quoted)
        for name in ("g++", "c++"):
            mine = folder / f"{os.getpid()}.{name}"
            mine.write_text(text)
            mine.chmod(0o755)
            mine.replace(script.with_name(name))
    return script.parent
