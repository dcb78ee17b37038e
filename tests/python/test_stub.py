# SPDX-License-Identifier: LGPL-2.1-or-later
"""The stub says what the module is: names, parameters, defaults, docstrings."""
import ast
import inspect
import pathlib
import re
from typing import get_args

import pytest

import swarf
from swarf import _native, aliases

STUB = ast.parse((pathlib.Path(_native.__file__).parent / "_native.pyi").read_text(encoding="utf-8"))
CLASSES = {node.name: node for node in STUB.body if isinstance(node, ast.ClassDef) and not node.name.startswith("_")}
FUNCTIONS = {node.name: node for node in STUB.body if isinstance(node, ast.FunctionDef)}


def public(names):
    return {name for name in names if not name.startswith("_")}


def decorators(node):
    return {item.id for item in node.decorator_list if isinstance(item, ast.Name)}


def stub_parameters(node):
    """[(name, kind, default)] without self or cls."""
    arguments = node.args
    result = []
    positional = arguments.posonlyargs + arguments.args
    defaults = [None] * (len(positional) - len(arguments.defaults)) + list(arguments.defaults)
    for index, (argument, default) in enumerate(zip(positional, defaults)):
        only = index < len(arguments.posonlyargs)
        kind = inspect.Parameter.POSITIONAL_ONLY if only else inspect.Parameter.POSITIONAL_OR_KEYWORD
        result.append((argument.arg, kind, default))
    for argument, default in zip(arguments.kwonlyargs, arguments.kw_defaults):
        result.append((argument.arg, inspect.Parameter.KEYWORD_ONLY, default))
    empty = inspect.Parameter.empty
    result = [(name, kind, empty if default is None else ast.literal_eval(default)) for name, kind, default in result]
    return [item for item in result if item[0] not in ("self", "cls")]


def native_parameters(thing):
    parameters = inspect.signature(thing).parameters.values()
    return [(item.name, item.kind, item.default) for item in parameters if item.name != "self"]


def test_the_module_has_what_the_stub_says_and_no_more():
    assert public(vars(_native)) == public([*CLASSES, *FUNCTIONS])


def test_functions():
    for name, node in FUNCTIONS.items():
        assert native_parameters(getattr(_native, name)) == stub_parameters(node), name
        assert getattr(_native, name).__doc__ and ast.get_docstring(node), name


def test_members_of_classes():
    checked = 0
    for name, node in CLASSES.items():
        native = getattr(_native, name)
        assert ast.get_docstring(node) and native.__doc__, name
        if issubclass(native, tuple):
            fields = [item.name for item in node.body if isinstance(item, ast.FunctionDef)]
            assert fields == list(native.__match_args__), name
            continue
        members = {item.name: item for item in node.body if isinstance(item, ast.FunctionDef)}
        if not issubclass(native, Exception):
            assert public(vars(native)) == public(members), name
        for member, item in members.items():
            thing = inspect.getattr_static(native, member)
            where = f"{name}.{member}"
            if member == "__new__":
                assert native_parameters(native) == stub_parameters(item), where
            elif "property" in decorators(item):
                assert inspect.isgetsetdescriptor(thing) and thing.__doc__, where
            elif not member.startswith("__"):
                assert isinstance(thing, type(vars(dict)["fromkeys"])) == ("classmethod" in decorators(item)), where
                assert native_parameters(getattr(native, member)) == stub_parameters(item), where
                assert thing.__doc__, where
            checked += 1
    assert checked > 50


def test_final_classes_cannot_be_subclassed():
    for name, node in CLASSES.items():
        if "final" in decorators(node):
            try:
                type("Sub", (getattr(_native, name),), {})
            except TypeError:
                continue
            raise AssertionError(f"{name} can be subclassed")


def test_the_package_offers_all_of_it():
    assert public(swarf.__all__) >= public([*CLASSES, *FUNCTIONS])
    for name in swarf.__all__:
        assert hasattr(swarf, name)


@pytest.mark.parametrize("words, call", [
    (aliases.View, lambda word: swarf.Camera.view(word, None)),
    (aliases.Dialect, lambda word: swarf.Program.parse_gcode("", dialect=word)),
    (aliases.PartKind, lambda word: swarf.Cutter("flat:d=6,l=20").radius(word)),
    (aliases.Colouring, lambda word: render(colouring=word)),
    (aliases.Buffers, lambda word: render(buffers=[word])),
])
def test_words_are_those_that_the_library_knows(words, call):
    with pytest.raises(ValueError) as error:
        call("no such word")
    known = re.search("is none of (.*)$", str(error.value)).group(1)
    assert set(get_args(words)) == set(known.split(", "))


def render(**words):
    stock = swarf.Stock.box((0, 0, 0), (1, 1, 1), 0.5)
    return swarf.Scene(stock).render(swarf.Camera.view("top", stock.bounding_box()), 4, 4, **words)
