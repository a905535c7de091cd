"""Mood of docstrings: modules, classes and values get a noun phrase, functions the imperative."""

import ast
import functools
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
WORDS = r"(?:What|Whether|How|Which|Why|Where|When|Who)\b.*"
DOCSTRING = re.compile(rf'^[ \t]*r?"""\s*{WORDS}', re.MULTILINE)
"""A text between three quotation marks that begins a line."""
COMMENT = re.compile(rf"(?:/\*\*[\s*]*|^//)\s*{WORDS}", re.MULTILINE)
"""A comment of JSDoc, of a module or at its top level."""
PAGE = "webviz/page/web"
PREPOSITION = re.compile(
    r"\s*(About|Above|After|Along|Among|As|At|Before|Behind|Below|Beside|Between|Beyond|By|During"
    r"|For|From|In|Of|On|Over|Per|Since|Through|To|Under|Until|When|With|Within|Without"
    r"|That|Those)(?![\w-])"
)
ROOMS = ("webviz", "displays", "urdf", "sim")
ARGUMENTS = re.compile(r"^Args:\n((?: +.*\n?|\n)+)", re.MULTILINE)
ARGUMENT = re.compile(r"^    (\*{0,2}\w+(?:, \*{0,2}\w+)*):", re.MULTILINE)
Function = ast.FunctionDef | ast.AsyncFunctionDef


@pytest.mark.parametrize(
    ("folder", "pattern"),
    [
        *((name, DOCSTRING) for name in ("webviz", "displays", "urdf", "sim", "ros", "tests")),
        (PAGE, COMMENT),
    ],
)
def test_no_docstring_or_comment_begins_as_a_question(
    folder: str, pattern: re.Pattern[str]
) -> None:
    files = sorted((ROOT / folder).rglob("*.js" if folder == PAGE else "*.py"))
    assert files
    faults = [
        f"{path.relative_to(ROOT)}: {' '.join(match.group().split())}"
        for path in files
        for match in pattern.finditer(path.read_text(encoding="utf-8"))
    ]
    assert faults == []


@functools.cache
def nodes(path: Path) -> tuple[ast.AST, ...]:
    """Return the nodes of a module that have a body; all tests share them."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return tuple(node for node in ast.walk(tree) if isinstance(getattr(node, "body", None), list))


def documented(doc: str) -> list[str]:
    """Return the names below "Args:" of a docstring."""
    section = ARGUMENTS.search(doc)
    names = ARGUMENT.findall(section[1]) if section else []
    return [name.strip(" *") for each in names for name in each.split(",")]


def accepted(node: Function | ast.ClassDef) -> set[str] | None:
    """Return the arguments of a function, or the fields of a class; None if they are unknown."""
    if isinstance(node, ast.ClassDef):
        makers = [each for each in node.body if isinstance(each, ast.FunctionDef)]
        results = {
            each.target.id
            for each in node.body
            if isinstance(each, ast.AnnAssign) and isinstance(each.target, ast.Name)
        }
        for maker in makers:
            if maker.name in ("__init__", "__new__"):
                own = accepted(maker)
                if own is None:
                    return None
                results |= own
        return results or None  # those of a class before it
    arguments = node.args
    extra = arguments.kwarg and arguments.kwarg.annotation
    if extra is not None and "Unpack" in ast.unparse(extra):
        return None
    every = [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs]
    every += [each for each in (arguments.vararg, arguments.kwarg) if each is not None]
    return {each.arg for each in every}


def strange_arguments(path: Path) -> Iterator[str]:
    """Return the documented arguments that do not exist."""
    for node in nodes(path):
        if not isinstance(node, Function | ast.ClassDef):
            continue
        names = documented(ast.get_docstring(node) or "")
        parameters = accepted(node) if names else None
        if parameters is not None:
            yield from (
                f"{path.name}, {node.name}: {name}" for name in names if name not in parameters
            )


@pytest.mark.parametrize("folder", ROOMS)
def test_every_documented_argument_exists(folder: str) -> None:
    files = sorted((ROOT / folder).rglob("*.py"))
    assert [each for path in files for each in strange_arguments(path)] == []


def docstrings(path: Path) -> Iterator[str]:
    """Return the docstrings of a module, its classes, functions, fields and constants."""
    for node in nodes(path):
        for statement in vars(node)["body"]:
            match statement:
                case ast.Expr(ast.Constant(str(text))):
                    yield text
                case _:
                    pass


@pytest.mark.parametrize("folder", [*ROOMS, "tests"])
def test_docstrings_begin_with_their_noun_or_verb(folder: str) -> None:
    faults = [
        f"{path.name}: {text[:60]}"
        for path in sorted((ROOT / folder).rglob("*.py"))
        for text in docstrings(path)
        if PREPOSITION.match(text)
    ]
    assert faults == []
