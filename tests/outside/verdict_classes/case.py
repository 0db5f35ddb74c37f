"""A scenario, what its run is to break, and how both are written down."""

from dataclasses import dataclass, field
from typing import Any

Tree = dict[str, Any]
NOTHING: frozenset[str] = frozenset()


@dataclass
class Case:
    """One random scenario, judged."""

    tree: Tree
    """What is in its file."""
    breaks: frozenset[str] = NOTHING
    """Requirements and limits that the run breaks: each must be told. Empty for a good one, which must not fail."""
    may_break: frozenset[str] = NOTHING
    """What else may be told of a bad one."""
    is_near: bool = False
    """Within 2 % of a threshold: left out."""
    note: str = ""
    """What the judgement rests on, with its numbers."""
    files: dict[str, str] = field(default_factory=dict)

    @property
    def is_bad(self) -> bool:
        return bool(self.breaks)


def quantity(value: float, unit: str) -> str:
    """A quantity as a scenario has it, to the last bit."""
    return f"{float(value)!r} {unit}"


def toml(tree: Tree) -> str:
    """A scenario file."""
    plain = {key: value for key, value in tree.items() if not is_table(value) and not is_tables(value)}
    lines = [f"{name(key)} = {inline(value)}" for key, value in plain.items()]
    for key, value in tree.items():
        tables = [value] if is_table(value) else value if is_tables(value) else []
        for table in tables:
            heading = f"[[{name(key)}]]" if is_tables(value) else f"[{name(key)}]"
            lines += ["", heading, *(f"{name(k)} = {inline(v)}" for k, v in table.items())]
    return "\n".join(lines) + "\n"


def is_table(value: Any) -> bool:
    return isinstance(value, dict)


def is_tables(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(map(is_table, value))


def name(key: str) -> str:
    return key if key.replace("_", "").isalnum() else f'"{key}"'


def inline(value: Any) -> str:
    match value:
        case bool():
            return "true" if value else "false"
        case int() | float():
            return repr(value)
        case str():
            return '"' + value.replace('"', '\\"') + '"'
        case list():
            return "[" + ", ".join(map(inline, value)) + "]"
        case dict():
            return "{ " + ", ".join(f"{name(k)} = {inline(v)}" for k, v in value.items()) + " }"
    raise TypeError(f"{value!r} is nothing for a scenario")
