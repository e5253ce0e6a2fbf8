"""Fuzz the reader of scene files: ``python -m tests.fuzz.reader 100000``.

With atheris (``pip install .[fuzz]``) coverage guides the mutation; without it the mutation is plain random.
"""

import random
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from time import monotonic

from comparisons.scene import Scene, SceneError, built_in_scenes, load_scene

TOKENS = [
    *(b"[[", b"]]", b"[", b"]", b"=", b'"', b"'", b'"""', b"#", b"\n", b",", b".", b"{", b"}", b"-", b"e", b"_", b"\\u"),
    *(b"nan", b"inf", b"-inf", b"true", b"1e999", b"-0.0", b"0x10", b"1979-05-27", b"07:32:00", b"\xff", b"\x00"),
    *(b"[scene]", b"[[beam]]", b"[[pin]]", b"[[contact]]", b"[[support]]", b"[[load]]", b"path = ", b"keep = true"),
    *(b"[[hinge]]", b"[[spring]]", b"[[stage]]", b"turn = ", b"stiffness = ", b"pin = [{"),
]  # fmt: skip


def reader(folder: Path) -> Callable[[bytes], bool]:
    """Return the harness: whether the reader takes some bytes; fails where it neither does nor refuses, each mistake in one line."""
    file = folder / "scene.toml"

    def read(data: bytes) -> bool:
        file.write_bytes(data)
        try:
            scene = load_scene(str(file))
        except SceneError as error:
            lines = str(error).splitlines()
            assert all(line.startswith(f"{file}: ") for line in lines), lines
            assert len(set(lines)) == len(lines), lines
            return False
        assert isinstance(scene, Scene)
        assert hash(scene) == hash(load_scene(str(file)))
        return True

    return read


def mutants(number: int, seed: int) -> list[bytes]:
    """Return scene files after random edits: most stay close to a scene, some do not."""
    draw = random.Random(seed)  # noqa: S311 - no secret
    scenes = [text.encode() for text in built_in_scenes().values()]
    return [_mutant(draw, draw.choice(scenes), scenes) for _ in range(number)]


def _mutant(draw: random.Random, data: bytes, scenes: list[bytes]) -> bytes:
    for _ in range(draw.randint(1, 6)):
        at, size = draw.randrange(len(data) + 1), draw.choice([0, 1, 2, 8, 64])
        other = draw.choice(scenes)
        start = draw.randrange(len(other))
        piece = draw.choice([b"", draw.randbytes(2), draw.choice(TOKENS), other[start : start + size]])
        data = data[:at] + piece + data[at + draw.choice([0, size]) :]
    return data


def main(runs: int) -> None:
    """Fuzz `runs` inputs; the first failure raises."""
    with tempfile.TemporaryDirectory() as folder:
        read = reader(Path(folder))
        try:
            import atheris
        except ImportError:
            began = monotonic()
            taken = sum(map(read, mutants(runs, 0)))
            print(f"{runs} files, {taken} taken, {monotonic() - began:.0f} s, plain random mutation")
            return
        corpus = Path(folder) / "corpus"
        corpus.mkdir()
        for name, text in built_in_scenes().items():
            (corpus / name).write_text(text)
        atheris.instrument_all()
        atheris.Setup([sys.argv[0], f"-runs={runs}", "-timeout=10", "-max_len=4096", str(corpus)], read)
        atheris.Fuzz()


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 100_000)
