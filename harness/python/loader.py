"""Loads a file of solvers in Python for bench, and calls them (docs/plugins.md). Compiled into plugin_bridge.cpp."""

import importlib.util
import inspect
import os
import platform
import sys
import traceback

DIRECTIONS = (None, "local", "start", "current", "end")  # as InextensibleDirection
WORDS = ("collider", "shear", "bending", "drag", "stiff_forces", "wants_forces", "middle", "whole_step", "no_limit",
         "momentum", "engine")  # of `takes`: the bits of InextensibleFlag, from the lowest
paths = []  # of files that were loaded


class Step:
    """What filter() and step() are given. Unknown attributes are errors."""
    __slots__ = ("h", "time", "x", "v", "x_start", "force", "pose", "settle", "iterations", "edge_projections",
                 "assemblies", "factorizations", "back_solves", "copy_seconds")


def told(error):
    """An exception in one line, with the last line of a solver's file that it went through."""
    places = [(frame.filename, frame.lineno) for frame in traceback.extract_tb(error.__traceback__) if frame.filename in paths]
    if isinstance(error, SyntaxError) and error.filename in paths:
        places.append((error.filename, error.lineno))
    where = "".join(f"{os.path.basename(path)}, line {line}: " for path, line in places[-1:])
    return " ".join((where + traceback.format_exception_only(error)[-1]).split())


def guarded(function, /, *arguments, **settings):
    """The function's result, or a text in one line: its own, or what it raised (SystemExit too)."""
    try:
        result = function(*arguments, **settings)
        return " ".join(result.split()) if isinstance(result, str) else result
    except BaseException as error:
        return told(error)


def setting(owner, name, value):
    """Name, meaning, initial, least, largest, both ends of the search range (0, 0: none), whether whole."""
    try:
        initial, least, largest, meaning, *search = value
        numbers = [initial, least, largest, *((0, 0) if not search else search[0])]
        if not isinstance(meaning, str) or len(search) > 1 or len(numbers) != 5:
            raise ValueError
        return name, meaning, *map(float, numbers), all(isinstance(number, int) for number in numbers[:3])
    except (TypeError, ValueError):
        raise TypeError(f"{owner}.settings['{name}'] is {value!r}, must be (initial, least, largest, meaning) or "
                        "(initial, least, largest, meaning, (least, largest) to search)") from None


def row(solver):
    """A class as a row: class, name of its method, name, summary, label, citation, kind, flags, direction, settings."""
    def declared(attribute, kind, default=None):
        value = getattr(solver, attribute, default)
        if not isinstance(value, kind):
            raise TypeError(f"{solver.__name__}.{attribute} is {value!r}, must be a {kind.__name__}")
        return value

    def place(attribute, value, permitted):
        if value not in permitted:
            raise ValueError(f"{solver.__name__}.{attribute}: {value!r}, must be one of {', '.join(map(str, permitted))}")
        return permitted.index(value)

    kinds = ("step", "filter")  # as InextensibleKind
    kind = getattr(solver, "kind", "step" if hasattr(solver, "step") and not hasattr(solver, "filter") else "filter")
    number = place("kind", kind, kinds)
    if not callable(getattr(solver, kind, None)):
        raise TypeError(f"{solver.__name__} has no method {kind}(self, step)")
    settings = declared("settings", dict, {})
    try:
        inspect.signature(solver).bind(None, **settings)
    except TypeError as error:
        raise TypeError(f"{solver.__name__}.__init__(self, scene, **settings) and `settings` do not match: {error}") from None
    takes = getattr(solver, "takes", ())
    flags = sum(1 << place("takes", word, WORDS) for word in ({takes} if isinstance(takes, str) else set(takes)))
    return (solver, kind, declared("name", str), declared("summary", str), declared("label", str, ""), declared("citation", str, ""),
            number, flags, place("direction", getattr(solver, "direction", None), DIRECTIONS),
            [setting(solver.__name__, name, value) for name, value in settings.items()])


def load(path):
    """The version of the file and its rows."""
    sys.stdout = sys.stderr  # standard output is bench's
    sys.dont_write_bytecode = True
    import numpy
    name = os.path.splitext(os.path.basename(path))[0]
    if name in sys.modules:
        raise ImportError(f"there is a module '{name}' already: the file needs another name")
    sys.path.insert(0, os.path.dirname(path))
    paths.append(path)
    spec = importlib.util.spec_from_file_location(name, path)
    module = sys.modules[name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    solvers = getattr(module, "solvers", None)
    if solvers is None:
        solvers = [value for value in vars(module).values() if inspect.isclass(value) and value.__module__ == name
                   and hasattr(value, "name") and hasattr(value, "summary")]
    if not solvers:
        raise TypeError("there is no class with `name` and `summary` (docs/plugins.md)")
    version = getattr(module, "__version__", f"Python {platform.python_version()}, numpy {numpy.__version__}")
    return str(version), [row(solver) for solver in solvers]
