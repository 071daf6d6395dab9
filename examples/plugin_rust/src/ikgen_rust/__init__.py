"""Rust as an output language of ikgen."""

from __future__ import annotations

from ikgen.generation.emitters import Emitter

__all__ = ["RUST"]

RUST = Emitter(
    "rust",
    "a Rust crate without dependencies",
    "ikgen_rust.emit:emit_derivation",
    "ikgen_rust.runner:rust_runner",
    main_file="{name}_ik_rs/src/lib.rs",
)
