"""The models from outside this package: programs of others, as adapters, program files, and entry points of other packages.

A program gets the resolved scene as JSON text and returns a response as JSON text.
"""

import json
import sys
from abc import abstractmethod
from collections.abc import Collection
from contextlib import redirect_stdout
from functools import cache, lru_cache
from importlib import import_module
from importlib.metadata import EntryPoint, entry_points
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from comparisons.answer import Response
from comparisons.extras import install
from comparisons.frozen import Value
from comparisons.models.model import Model, ModelError, Options, Style, Watch
from comparisons.models.outside.adapters.exchange import Refusal, States, answered
from comparisons.models.outside.child import ProgramError, ProgramStatus, found, run
from comparisons.models.outside.exchange import answer, refusal, request, unanswered
from comparisons.scene import Scene, rules
from comparisons.scene.rules import Rule, ValueRule
from comparisons.scene.tables import InputError, check_keys, head_values, read_tables, read_text, refuse

SUFFIX = ".toml"
"""Suffix of a program file."""


class Program(Value, Model):
    """A program of others, which reads the text of a resolved scene and writes the text of a response."""

    name: str
    label: str = ""  #: Name in figures and texts; the name of the model if empty.
    #: Numbers of elements along a beam that comparisons of cost run; empty if the program chooses its resolution itself.
    elements: tuple[int, ...] = ()
    colour: str = "#AA3377"  #: Colour of its lines, in hexadecimal digits.
    continuum: bool = False  #: Whether it computes a two-dimensional body.
    #: ``refuses(scene)``: why the program cannot state the scene, None if it can; without it the program itself is asked.
    refuses: Refusal | None = None

    def _settle(self) -> None:
        vars(self).update(
            label=self.label or self.name,
            options=("elements",) if self.elements else (),
            style=Style(colour=self.colour, marker="D"),
        )

    @abstractmethod
    def sources(self) -> tuple[bytes, *tuple[Path, ...]]:
        """Return a text and files, as far as they are there, on which its answers depend."""

    @abstractmethod
    def ask(self, text: str) -> bytes:
        """Return the answer to a scene; raise `ProgramError` if there is none."""

    def missing(self) -> str | None:
        """Return what must be installed; None if it can be found."""
        return None

    @property
    def identity(self) -> str:
        """Name of the program, and a digest of what its answers depend on."""
        import hashlib  # 2 ms that only a study needs

        text, *files = self.sources()
        parts = (text, *(file.read_bytes() if file.is_file() else b"" for file in files))
        digest = hashlib.sha256(b"\0".join(parts)).hexdigest()
        return f"{self.name} {digest}"

    def refusal(self, scene: Scene) -> str | None:
        """Return why the program cannot state the scene, or what is missing to run it."""
        return self.unstated(scene) or _refusal(self, scene) or self.missing()

    def solve(self, scene: Scene, options: Options, watch: Watch) -> Response:  # noqa: ARG002 - a program states no steps
        """Return the response to `scene`, not yet checked. Its status names what failed if there is none."""
        if (missing := self.missing()) is not None:
            raise ModelError(missing)
        try:
            return answer(self.ask(request(scene, options, scene.times)), scene, self.name)
        except ProgramError as error:
            return unanswered(scene, self.name, error)

    def setting(self, scene: Scene, options: Options) -> str:
        """Return the numbers of elements; empty if the program chooses its resolution itself."""
        counts = {options.elements or beam.divisions for beam in scene.beams} if self.options else set()
        return "+".join(map(str, sorted(counts)))

    def resolutions(self, *, quick: bool) -> tuple[Options, ...]:
        """Return the program's numbers of elements; the first two if quick."""
        return tuple(Options(elements=n) for n in self.elements[: 2 if quick else None]) or (Options(),)


class Command(Program):
    """A command in a child process: the resolved scene goes to its standard input, a response comes from its standard output."""

    #: The program and its arguments. A program with a separator in its path is relative to `folder`.
    command: tuple[str, ...]
    folder: Path  #: Working directory of the program.
    seconds: float = 600.0  #: Limit on the wall time [s].
    #: Limit on the resident memory of the program and all its child processes [MB], on Linux.
    memory: float = 4000.0
    environment: tuple[str, ...] = ()  #: Variables of the environment that it gets beside the usual ones.
    #: Python module or program without which `command` cannot run, by default its program.
    requires: str = ""
    needs: str = ""  #: How to install what it requires.

    def sources(self) -> tuple[bytes, *tuple[Path, ...]]:
        """Return the command, and the files among its words."""
        return json.dumps(self.command).encode(), *(self.folder / word for word in self.command)

    def missing(self) -> str | None:
        """Return what must be installed to run the command; None if it can be found."""
        program = self.requires or self.command[0]
        there = found(program, self.folder) or (self.requires and find_spec(program))
        return None if there else self.needs or f"there is no program {program}"

    def ask(self, text: str) -> bytes:
        """Run the command."""
        return run(self.command, self.folder, text, self.seconds, self.memory, self.environment)


class Functions(Program):
    """Functions in this process, as `comparisons.models.outside.adapters.exchange.serve` takes them."""

    #: ``states(scene, histories)``: adds the states to `histories` and yields the load parameter of each.
    states: States

    def sources(self) -> tuple[bytes, *tuple[Path, ...]]:
        """Return the file that defines the states."""
        return b"", Path(self.states.__code__.co_filename)

    def ask(self, text: str) -> bytes:
        """Call the functions. If one raises, the status of the response names the exception. What they print goes to standard error."""
        try:
            with redirect_stdout(sys.stderr):
                return json.dumps(answered(json.loads(text), self.refuses, self.states)).encode()
        except Exception as error:
            raise ProgramError(ProgramStatus.CRASHED, f"{type(error).__name__}: {error}") from error


@lru_cache(maxsize=256)
def _refusal(program: Program, scene: Scene) -> str | None:
    """Return why a scene without load parameters is refused; a program that fails does not refuse it."""
    text = request(scene, Options(), ())
    if program.refuses is not None:
        return program.refuses(json.loads(text))
    try:
        return refusal(program.ask(text))
    except ProgramError:
        return None


def _refusal_of(module: str) -> Refusal:
    return lambda scene: import_module(module).refusal(scene)


ADAPTERS: dict[str, Program] = {
    name: Command(
        name=name, label=label, command=(sys.executable, "-m", module), folder=Path(__file__).parents[3],
        elements=(10, 20, 40, 80), colour=colour, requires=requires, needs=needs, continuum=continuum,
        refuses=_refusal_of(module),
    )
    for name, label, colour, requires, needs, continuum in (
        ("calculix", "CalculiX", "#117733", "ccx", "Debian's calculix-ccx is needed: there is no program ccx", True),
        ("exudyn", "Exudyn", "#999933", "exudyn", f"exudyn is needed: {install('exudyn')}", False),
        ("felupe", "FElupe", "#DDCC77", "felupe", f"felupe is needed: {install('felupe')}", True),
        ("opensees", "OpenSees", "#882255", "openseespy", f"openseespy is needed: {install('openseespy')}, and Debian's libblas3", False),
    )
    for module in [f"{__package__}.adapters.{name}"]
}  # fmt: skip
"""The adapters by name: label, colour, what it requires, how to install that, and whether it computes a two-dimensional body. Each is a
module of this package, which runs in the folder where the package lies."""
_USED: dict[str, Model] = {}
"""The models from outside that this process has used, by name."""


def outside(name: str, taken: Collection[str]) -> Model:
    """Return a model that is none of this package.

    The name is that of a program file ``NAME.toml``, of one read before, of an adapter, or of an entry point. An `InputError` is
    raised if the file cannot be read or states a name in `taken`, a `ModelError` if there is no such model.
    """
    model = read_program(Path(name)) if name.endswith(SUFFIX) else known(name)
    if model is None and name in offered():
        model = loaded(offered()[name], Model)
    if model is None:
        raise ModelError(f"model = {name}: must be one of {', '.join(taken)}, or a program file NAME.toml")
    if model.name in taken or model is not ADAPTERS.get(model.name, model):
        raise InputError(name, f'program.name = "{model.name}": must not be the name of a model')
    _USED[model.name] = model
    return model


def known(name: str) -> Model | None:
    """Return the adapter of a name, or the model from outside that this process has used by it; None if there is none."""
    return ADAPTERS.get(name) or _USED.get(name)


def used() -> tuple[Model, ...]:
    """Return the models from outside that this process has used."""
    return tuple(_USED.values())


@cache
def offered(group: str = "crossval.models") -> dict[str, EntryPoint]:
    """Return the entry points by which installed packages offer models, or another group, by their names; nothing is imported."""
    return {point.name: point for point in entry_points(group=group)}


def loaded(point: EntryPoint, kind: type[Any]) -> Any:
    """Return what an entry point yields; raise `ModelError` unless it is an object of a type that has the entry point's name."""
    where = f"entry point {point.name} = {point.value}"
    try:
        found = point.load()
    except Exception as error:
        raise ModelError(f"{where}: {type(error).__name__}: {error}") from error
    if not isinstance(found, kind) or found.name != point.name:
        raise ModelError(
            f"{where}: must be {'an' if kind is not Model else 'a'} {kind.__name__} of this name"
        )
    return found


def read_program(path: Path) -> Program:
    """Return the program that the TOML file `path` states in its table ``[program]`` by the keys of `RULES`; it runs in the file's folder.

    ``docs/how-to/program.md`` has the keys. An `InputError` has all mistakes in the order of the file.
    """
    source = str(path)
    tables = read_tables(read_text(source), source)
    given, mistakes = head_values(tables, "program", RULES, required=("name", "command"))
    mistakes += check_keys(tables, ("program",), required=("program",))
    refuse(source, mistakes, tables)
    return Command(folder=path.resolve().parent, **given)


def _list(items: str, rule: ValueRule, least: int = 0) -> ValueRule:
    return ValueRule(f"a list of {items}", rules.several(rule.schema, least))


RULES: dict[str, Rule] = {
    "name": rules.name,
    "command": _list("texts, the program first", rules.text, 1),
    "label": rules.text,
    "seconds": rules.positive,
    "memory": rules.positive,
    "environment": _list("texts", rules.text),
    "elements": _list("whole numbers", rules.whole_number),
    "colour": ValueRule("a colour, as #AA3377", rules.worded("^#[0-9a-fA-F]{6}$")),
    "continuum": rules.truth,
}
"""The keys of a program file with the rules of their values."""
